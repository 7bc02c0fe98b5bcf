// Peaks and margins as the contract tells them.
#pragma once

#include "engine/evaluation/evaluation.h"
#include "engine/loop/margins.h"
#include "engine/loop/peaks.h"
#include "engine/loop/stability.h"

namespace tunewright {

/// Of a stable loop.
Robustness robustness_of(const Peaks& peaks, const Margins& margins);

/// Every figure empty, and why.
Robustness unstable_robustness(const StabilityCount& count);

}  // namespace tunewright
