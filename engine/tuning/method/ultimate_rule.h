// The common part of the rules on the ultimate point: the origin of Ku and Pu.
#pragma once

#include <optional>

#include "engine/tuning/method/rule.h"

namespace tunewright {

enum class UltimateSource {
    model,  ///< computed from the plant, with the exact dead time
    relay,  ///< by the describing function of the recorded relay test
};

/// Origin of Ku and Pu: both given, or from `ultimate`.
struct UltimateOptions {
    UltimateSource ultimate = UltimateSource::model;
    std::optional<double> Ku = {}, Pu = {};
};

OptionSet<UltimateOptions> ultimate_options();

/// Ku and Pu by these options. Errors: invalid_argument for Ku without Pu or the reverse, Ku = 0, "relay" without a
/// recorded relay test; unsupported, `where` "plant", if no proportional gain makes the loop oscillate, and for a zero
/// at the origin.
Expected<UltimatePoint> chosen_ultimate_point(const TuningProblem& problem, const UltimateOptions& options);

/// 1/(K Ku): 0 for integrating plants, near 1 for a pure dead time.
double gain_ratio(const LinearPlant& plant, const UltimatePoint& at);

/// Warnings for a plant that only a range of gains stabilises, for which a fixed share of Ku may be too small.
std::vector<Warning> ultimate_warnings(const TuningProblem& problem);

}  // namespace tunewright
