// Detects whether a controller moves u in response to y.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// A move of u that y does not explain, in a record in which y explains the others: by the operator or by the set
/// point.
struct OutsideMove {
    double time = 0;  ///< dimensionless
    double size = 0;  ///< size of the set-point step that would cause it, dimensionless y
};

/// Evidence that u follows y. Errors are root mean squares of the unexplained moves of u, without the largest twentieth
/// of them.
struct Feedback {
    double by_u = 0;                   ///< error of predicting u's moves from u's own past, dimensionless
    double by_y = 0;                   ///< the same from y and u's past, with as many coefficients
    bool at_once = false;              ///< true: y of the same row explains u; false: y of earlier rows does
    double gain = 0;                   ///< gain from y to u in the same row, dimensionless; 0 if there is no plain law
    std::vector<OutsideMove> outside;  ///< only if the controller's law is plain enough
};

/// u at each sample, dimensionless.
std::vector<double> input_at_samples(const CleanRecord& record);

/// Compares two predictions of u's moves, from u's own past and from y (of the same row and the rows before) with less
/// of u's past, equal numbers of coefficients (Granger 1969; with the same row, the linear law of a sampled P, PI or
/// PID controller in its differenced form, in which the set point is a rare outlier). If u moves in fewer than half of
/// the rows, only its moves are used. Feedback is found if y halves the error, or lowers it by more than chance and by
/// more than u's past lowers the error of predicting y: in an open-loop test the new information is in u, in a loop it
/// is in y. It is also found if rounded levels show a proportional law (level_law.h). Empty for relay tests, for u on
/// two or three levels, for fewer than 12 moves, and if u has no new information (ramps, sines).
std::optional<Feedback> find_feedback(const CleanRecord& record);

/// True if u moves as a controller may move it: 12 times or more, on more than three levels, neither like a relay nor
/// on ramps.
bool may_be_controlled(const CleanRecord& record);

/// Irregularity of u: the error of predicting its moves from its own past, over u's standard deviation. 0 if u moves as
/// in a test: in fewer than a tenth of the rows, on ramps, on two or three levels, like a relay; or if y follows u of
/// the same row like a lag.
double restlessness(const CleanRecord& record);

}  // namespace tunewright
