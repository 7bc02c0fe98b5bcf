// How far a parameter may move before J has risen by 5 %, from the Hessian of J at the optimum.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "engine/tuning/emulation/search/parameters.h"

namespace tunewright::emulation {

constexpr double kRise = 0.05;

struct Flatness {
    std::vector<double> reoptimised, alone;  ///< one an unknown; the others follow, or stay
};

/// `J` is finite near `optimum`, on both sides of bounds; `sizes` are those that the unknowns may have. An optimum on a
/// bound counts with its curvature all the same. Empty: no curvature that could be told from rounding.
std::optional<Flatness> flatness(const std::function<double(const SettingsPoint&)>& J, const SettingsPoint& optimum,
                                 const SettingsPoint& sizes);

}  // namespace tunewright::emulation
