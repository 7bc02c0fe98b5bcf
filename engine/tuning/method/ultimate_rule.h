// What the rules on the ultimate point share: where Ku and Pu come from.
#pragma once

#include "engine/tuning/method/rule.h"

namespace tunewright {

/// Options `Ku`, `Pu` (by hand) and `ultimate`: "model" (computed from the plant, dead time exact) or "relay" (the
/// describing function's of the recorded relay test), and `filter` with this law.
std::vector<OptionDescription> with_ultimate_options(std::vector<OptionDescription> own, const std::string& filter_law);

/// Ku and Pu by these options. Errors: invalid_argument for Ku without Pu or the reverse, Ku = 0, "relay" without a
/// recorded relay test; unsupported, `where` "plant", where no proportional gain makes the loop oscillate,
/// and for a zero at the origin.
Expected<UltimatePoint> chosen_ultimate_point(const TuningProblem& problem, const MethodOptions& options);

/// 1/(K Ku): 0 for integrating plants, near 1 for a pure dead time.
double gain_ratio(const LinearPlant& plant, const UltimatePoint& at);

/// Of a plant that only some gains stabilise, on which a fixed share of Ku may be too weak.
std::vector<Warning> ultimate_warnings(const TuningProblem& problem);

}  // namespace tunewright
