// When no controller meets the limits: how far from feasible, and when the optimum has no end.
#pragma once

#include <optional>

#include "engine/tuning/robust/design.h"

namespace tunewright::robust {

/// The smallest M for which some controller keeps Ms and Mt <= M (both at once), to about 0.1 %; empty if none
/// stabilises the plant.
std::optional<double> smallest_common_peak(const Problem& problem);

/// True where the gain can grow for ever within the limits: no dead time, no right-half-plane zero, and a design of the
/// plant's high-frequency asymptote that scales with frequency exists (Tf tied to Td, or no filter).
bool has_no_finite_optimum(const Problem& problem);

}  // namespace tunewright::robust
