// Servo/regulation rules: one PID for set points and loads, by robustness or by allowed degradation.

#pragma once

#include "engine/tuning/arrieta/arrieta_rule.h"
#include "engine/tuning/method/rule.h"

namespace tunewright {

struct ArrietaMsOptions {
    std::optional<double> Ms = 1.6;  ///< on the model; empty ("free"): no limit
    ArrietaC3 c3 = ArrietaC3::refitted;
    bool profile = false;  ///< also return what the rule offers on the model
    ReductionOptions reduction = {};
};

struct ArrietaDegradationOptions {
    double degradation = 0.35;
    std::optional<bool> exact = {};  ///< solve on the model; false: the table alone; empty: the table at its levels
    bool profile = false;
    ReductionOptions reduction = {};
};

/// Option Ms: "free" (no limit: the least J_rd) or a number from 1.4 to 2, which Ms on the model then is about. Table 1
/// at its levels, Eq. 9 in between, with b3 corrected and c3 refitted, or as printed with option c3 = "printed" (see
/// arrieta_rule.h).
TuningMethod arrieta_ms_method();

/// Option degradation: how much of the combined performance I_perf may be given up (tradeoff.h). Table 2 at its levels
/// (0, 0.25, 0.35, 0.45, 0.55) unless `exact` is true. In between, and with `exact`, the smallest Ms from 1.4 to 2 is
/// taken with which Eq. 9 (b3 corrected, c3 refitted) has that degradation on the model; in between without the option
/// a warning `exact-degradation` says so, and `exact` false is refused there. What no Ms reaches is refused with the
/// range.
TuningMethod arrieta_degradation_method();

}  // namespace tunewright
