// A controller known by its law: u as P, PI or PID of the recorded y and set point, over the whole record.
#pragma once

#include <optional>
#include <vector>

#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// u = constant - Kp y + Ki int (r - y) dt - Kd dy/dt + b r; dimensionless.
struct ControllerLaw {
    double gain = 0;      ///< of u over y in the same row: -Kp
    double integral = 0;  ///< Ki
    double left = 0;      ///< share of u's variance that the law leaves, 0 to 1
};

/// feedback.h asks which of u and y has the news from row to row. In a short or a smooth record neither has: each is
/// predicted by its own past. There the law of a controller, four or five numbers for all rows, is plain.
///
/// It is found where it leaves less than a hundredth of u's variance, where Kp and Ki have one sign, as those of a
/// controller do, and where u is not a sine, whose every filter explains it, nor a lag that follows one step and by
/// itself explains u as well as the law does: a soft start by hand. Rows at the ends of u, three and more in a
/// row, are left out: there the actuator holds u. Between them the constant is free, as after a switch or a windup. A
/// smooth test in manual may look so too: the law says something only beside what u explains of y.
///
/// `u` is the input at the samples, dimensionless; `r` is the set point at the samples, dimensionless as y, or empty:
/// then one that does not move is assumed. Empty for fewer than 40 rows in which u moves.
std::optional<ControllerLaw> controller_law(const CleanRecord& record, const std::vector<double>& u,
                                            const std::vector<double>& r);

/// The share of y's variance that a free linear plant, by filters of u of the rows before (set_point_part.h), leaves.
double left_by_free_plant(const CleanRecord& record, const std::vector<double>& u);

}  // namespace tunewright
