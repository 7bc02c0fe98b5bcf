// The measurement filter of a robust design: given by the options, or chosen from the plant.
#pragma once

#include <optional>

#include "engine/expected.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/robust/design.h"

namespace tunewright {

/// Filter of the measurement, second order: Tf, or a fraction of Td; neither: chosen from the plant.
struct RobustFilterOptions {
    std::optional<double> Tf = {}, Tf_over_Td = {};
};

namespace robust {

/// The filter of the options, if there is one. Error: invalid_argument for Tf_over_Td with a PI.
Expected<std::optional<FilterRule>> explicit_filter(const RobustFilterOptions& options, bool pid);

/// The given filter; else none for PI, Tf = 0.1 Td for plants with a dead time, a right-half-plane zero or pole excess
/// >= 3, and Tf = 0.05 of the lags minus the leads for the others. Error: unbounded_optimum ("filter") for a plant with
/// neither dead time nor lags.
Expected<FilterRule> filter_rule(const TuningProblem& problem, const RobustFilterOptions& options, bool pid);

/// The sign of Kp with which a low gain drives the output towards the set point: that of K/T of the plant's first
/// slope.
double first_sign(const LinearPlant& plant);

}  // namespace robust
}  // namespace tunewright
