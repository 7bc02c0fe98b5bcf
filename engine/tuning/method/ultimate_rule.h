// What the rules on the ultimate point share: where Ku and Pu come from.
#pragma once

#include <optional>

#include "engine/tuning/method/rule.h"

namespace tunewright {

enum class UltimateSource {
    model,  ///< computed from the plant, dead time exact
    relay,  ///< by the describing function of the recorded relay test
};

/// Where Ku and Pu come from: given by hand, both, or from `ultimate`.
struct UltimateOptions {
    UltimateSource ultimate = UltimateSource::model;
    std::optional<double> Ku = {}, Pu = {};
};

OptionSet<UltimateOptions> ultimate_options();

/// Ku and Pu by these options. Errors: invalid_argument for Ku without Pu or the reverse, Ku = 0, "relay" without a
/// recorded relay test; unsupported, `where` "plant", where no proportional gain makes the loop oscillate,
/// and for a zero at the origin.
Expected<UltimatePoint> chosen_ultimate_point(const TuningProblem& problem, const UltimateOptions& options);

/// 1/(K Ku): 0 for integrating plants, near 1 for a pure dead time.
double gain_ratio(const LinearPlant& plant, const UltimatePoint& at);

/// Of a plant that only some gains stabilise, on which a fixed share of Ku may be too weak.
std::vector<Warning> ultimate_warnings(const TuningProblem& problem);

}  // namespace tunewright
