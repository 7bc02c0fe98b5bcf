// What of u the set point moved: the part of a loop's record that feedback of disturbances has no share in.
#pragma once

#include <optional>
#include <vector>

#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// u = constant + linear filter of the set point + rest, by least squares over a set-point step's usual answers:
/// Laguerre filters of one pole (Wahlberg 1991), the pole that leaves least. The filter needs to be near only: what
/// it misses makes the instrument weaker, not wrong. Vectors have one value for each sample.
struct SetPointPart {
    std::vector<double> u;                      ///< the part, from 0 at the first sample, dimensionless
    std::vector<std::vector<double>> filtered;  ///< the set point, its moves and its filtered versions
    double share = 0;                           ///< of the variance of u that the part explains, 0 to 1
    double strength = 0;                        ///< F ratio, the rest counted as the independent samples it is worth
};

/// `u` is the input at the samples, dimensionless; `w` is the set point at the samples, in any unit, and `before` what
/// it was before the first. The lengths are equal. Empty where w never moves, or for fewer than 32 samples. Cost: nine
/// least-squares problems of 11 columns and as many rows as there are samples.
std::optional<SetPointPart> set_point_part(const std::vector<double>& u, const std::vector<double>& w, double before);

/// The record with that part in place of u, as changes at the sample times; of samples at one time the last counts.
/// `part` is of the record's samples.
CleanRecord driven_by(const SetPointPart& part, const CleanRecord& record);

}  // namespace tunewright
