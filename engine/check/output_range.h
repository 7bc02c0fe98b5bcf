// The range of a loop's output: where its limits are.
#pragma once

#include "engine/check/loop_check.h"
#include "engine/check/samples.h"
#include "engine/check/thresholds.h"

namespace tunewright::check {

struct OutputRange {
    double low = 0, high = 100;
    bool known = true;                         ///< false: somewhat more than what was seen
    bool low_known = true, high_known = true;  ///< false: nothing is at this limit

    double width() const { return high - low; }
    bool at_low(double u) const { return low_known && u <= low + kAtLimit * width(); }
    bool at_high(double u) const { return high_known && u >= high - kAtLimit * width(); }
    bool at_limit(double u) const { return at_low(u) || at_high(u); }
};

/// As the loop or its record gives it. A value at which the output rests again and again is a limit nearer by, as
/// controllers have. Else 0 to 100 for an output that stays within -5 and 105, where controllers end,
/// and 0 to 1 where no sample exceeds 1.05.
OutputRange output_range(const LoopQuestion& question, const Samples& samples);

}  // namespace tunewright::check
