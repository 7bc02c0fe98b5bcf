// The second level's optimum within its bounds: a global search, then Gauss-Newton steps on the residuals.

#pragma once

#include <optional>
#include <vector>

#include "engine/tuning/emulation/criterion.h"

namespace tunewright::emulation {

/// The result of the search.
struct Optimum {
    SettingsPoint point;
    Cost cost;             ///< simulated to kFineTolerance
    bool stopped = false;  ///< true: stopped, the best design so far
};

/// The least J within `bounds`: DIRECT over the box (NLopt) and `starts`, the best of them refined by bounded
/// Levenberg-Marquardt steps, then by NLopt's subplex if these end before a minimum. Empty: stopped before the first
/// evaluation.
std::optional<Optimum> find_optimum(const Criterion& criterion, const Bounds& bounds,
                                    const std::vector<SettingsPoint>& starts, const RunControl& control);

/// Tolerance of the last simulations, which compute J to the digits of the answer.
constexpr double kFineTolerance = 1e-9;

}  // namespace tunewright::emulation
