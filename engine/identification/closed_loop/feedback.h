// Whether a controller moves u in answer to y.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// A move of u that y does not explain, in a record in which y explains the others: the operator's, or the set point's.
struct OutsideMove {
    double time = 0;  ///< dimensionless
    double size = 0;  ///< of the step of the set point that the controller would answer so, dimensionless y
};

/// What shows that u follows y. Errors are root mean squares of the moves of u that are left unexplained, without the
/// largest twentieth of them.
struct Feedback {
    double by_u = 0;                   ///< error of predicting u's moves from u's own past, dimensionless
    double by_y = 0;                   ///< the same from y and u's past, with as many coefficients
    bool at_once = false;              ///< y of the same row explains u; else y of the rows before does
    double gain = 0;                   ///< of u over y in the same row, dimensionless; 0 where the law is not plain
    std::vector<OutsideMove> outside;  ///< where the controller's law is plain enough to tell
};

/// u at each sample, dimensionless.
std::vector<double> input_at_samples(const CleanRecord& record);

/// Compares two predictions of u's moves, from u's own past and from y (of the same row and the rows before) with less
/// of u's past, equal numbers of coefficients (Granger 1969; with the same row, the linear law of a sampled P, PI or
/// PID controller in its differenced form, in which the set point is a rare outlier). Where u moves in fewer than half
/// of the rows, the moves alone are looked at. Feedback is found where y halves the error, or lowers it by more than
/// chance and more than u's past lowers the error of predicting y: an open-loop test has its news in u, a loop in y.
/// So is it where levels that are rounded show a proportional law (level_law.h).
/// Empty for relay tests, for u on two or three levels, for fewer than 12 moves, and where u has no news (ramps,
/// sines).
std::optional<Feedback> find_feedback(const CleanRecord& record);

/// True if u moves as a controller may move it: 12 times or more, on more than three levels, neither as a relay nor on
/// ramps.
bool may_be_controlled(const CleanRecord& record);

/// How restlessly u moves: the error of predicting its moves from its own past over u's standard deviation. 0 where u
/// moves as tests do: in fewer than a tenth of the rows, on ramps, on two or three levels, as a relay; or where y
/// follows u of the same row as a lag does.
double restlessness(const CleanRecord& record);

}  // namespace tunewright
