// Which filter a robust design has where its options leave it open, and which sign its gain.
#pragma once

#include <optional>

#include "engine/expected.h"
#include "engine/tuning/method/method.h"
#include "engine/tuning/robust/design.h"
#include "engine/tuning/robust/robust.h"

namespace tunewright::robust {

/// The filter that the options give, if they do. Error: invalid_argument for Tf_over_Td of a PI.
Expected<std::optional<FilterRule>> explicit_filter(const RobustFilterOptions& options, bool pid);

/// The contract's filter rule: what is given; else none for PI, Tf = 0.1 Td for plants with a dead time, a
/// right-half-plane zero or pole excess >= 3, and Tf = 0.05 of the lags minus the leads for the others. Error:
/// unbounded_optimum ("filter") for a plant with neither dead time nor lags.
Expected<FilterRule> filter_rule(const TuningProblem& problem, const RobustFilterOptions& options, bool pid);

/// Low gain of the right sign must push the output towards the set point: K/T of the plant's first slope decides.
double first_sign(const LinearPlant& plant);

}  // namespace tunewright::robust
