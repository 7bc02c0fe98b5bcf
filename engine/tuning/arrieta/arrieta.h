// Servo/regulation rules: one PID for set points and loads, by robustness or by allowed degradation.

#pragma once

#include "engine/tuning/arrieta/arrieta_rule.h"
#include "engine/tuning/method/rule.h"

namespace tunewright {

struct ArrietaMsOptions {
    std::optional<double> Ms = 1.6;  ///< on the model; empty ("free"): no limit
    ArrietaC3 c3 = ArrietaC3::refitted;
    bool profile = false;  ///< also return the rule's trade-off on the model
    ReductionOptions reduction = {};
};

struct ArrietaDegradationOptions {
    double degradation = 0.35;
    std::optional<bool> exact = {};  ///< true: solve on the model; false: use Table 2 only; empty: Table 2 at its
                                     ///< levels, the model elsewhere
    bool profile = false;
    ReductionOptions reduction = {};
};

/// Option Ms: "free" (no limit: the least J_rd) or a number from 1.4 to 2, the approximate Ms on the model. Table 1 at
/// its levels, Eq. 9 in between, with b3 corrected and c3 refitted, or as printed with option c3 = "printed" (see
/// arrieta_rule.h).
TuningMethod arrieta_ms_method();

/// Option degradation: the allowed loss of combined performance I_perf (tradeoff.h). Table 2 at its levels (0, 0.25,
/// 0.35, 0.45, 0.55) unless `exact` is true. In between, and with `exact`, the smallest Ms from 1.4 to 2 is taken with
/// which Eq. 9 (b3 corrected, c3 refitted) has that degradation on the model; without the option the warning
/// `exact-degradation` reports this, and with `exact` false a value in between is an error. A degradation that no Ms
/// has is an error with the possible range.
TuningMethod arrieta_degradation_method();

}  // namespace tunewright
