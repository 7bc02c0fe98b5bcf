// What has changed between two checks of one loop, and whether chance explains it.
#pragma once

#include "engine/check/loop_check.h"

namespace tunewright::check {

struct Change {
    Verdict before = Verdict::undetermined, now = Verdict::undetermined;
    Figure variability_ratio = {};  ///< standard deviation of the error, now over before
    Figure likelihood = {};  ///< of so large a change by chance, 0 to 1: two-sided F test of the variances
    bool significant = false;  ///< the likelihood is below kByChance
};

inline constexpr double kByChance = 0.01;

/// The F test takes each record for as many independent values as its error has.
Change change_of(const LoopCheck& before, const LoopCheck& now);

}  // namespace tunewright::check
