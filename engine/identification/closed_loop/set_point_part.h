// What of u the set point moved: the part of a loop's record that feedback of disturbances has no share in.
#pragma once

#include <optional>
#include <vector>

#include "engine/identification/record/clean_record.h"

namespace tunewright {

/// u = constant + linear filter of the set point + rest, by least squares over a set-point step's usual answers:
/// Laguerre filters of one pole (Wahlberg 1991), the pole that leaves least. The filter needs to be near only: what
/// it misses makes the instrument weaker, not wrong.
struct SetPointPart {
    std::vector<double> u;                      ///< at the samples, from 0 at the first, dimensionless
    std::vector<std::vector<double>> filtered;  ///< the set point and its filtered versions, at the samples
    double share = 0;                           ///< of the variance of u
    double strength = 0;                        ///< F ratio, rest counted as the independent samples it is worth
};

/// `w` is the set point at the samples, any unit. Empty where w never moves.
std::optional<SetPointPart> set_point_part(const std::vector<double>& u, const std::vector<double>& w);

/// The record with that part in place of u.
CleanRecord driven_by(const SetPointPart& part, const CleanRecord& record);

}  // namespace tunewright
