// The part of u that the set point moved: the part of a loop's record that does not depend on disturbances.
#pragma once

#include <optional>
#include <vector>

#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// u = constant + linear filter of the set point + rest, by least squares with filters like the usual responses to a
/// set-point step: Laguerre filters with one pole (Wahlberg 1991), the pole with the least residual. The filter need
/// only be approximate: an error makes the instrument weaker, not wrong. Vectors have one value for each sample.
struct SetPointPart {
    std::vector<double> u;                      ///< the part, from 0 at the first sample, dimensionless
    std::vector<std::vector<double>> filtered;  ///< the set point, its moves and its filtered versions
    double share = 0;                           ///< of the variance of u that the part explains, 0 to 1
    double strength = 0;                        ///< F ratio, with the residual counted as its number of independent
                                                ///< samples
};

/// `u` is the input at the samples, dimensionless; `w` is the set point at the samples, in any unit, and `before` its
/// value before the first. The lengths are equal. Empty if w never moves, or for fewer than 32 samples. Cost: nine
/// least-squares problems with 11 columns and one row for each sample.
std::optional<SetPointPart> set_point_part(const std::vector<double>& u, const std::vector<double>& w, double before);

/// The record with that part in place of u, as changes at the sample times; of samples at the same time the last
/// counts. `part` belongs to the record's samples.
CleanRecord driven_by(const SetPointPart& part, const CleanRecord& record);

}  // namespace tunewright
