// Peaks and margins of a stable loop from a dense walk along the imaginary axis.
//
// 1. omega rises from far below the lowest corner to far above the highest by a constant small ratio, in smaller steps
//    around lightly damped roots, and by a small part of a turn of the dead time while its turns can still matter:
//    while the envelope of |S|, |T| or |C S| exceeds its largest value so far, or |L| that of the gain margin.
// 2. Every local maximum near the largest value is refined by golden section; the ends of the axis are its limits.
// 3. Crossings of the unit circle and of the negative real axis are bisected.
#pragma once

#include <optional>

#include "engine/evaluation/evaluation.h"
#include "engine/expected.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright::verify {

/// The frequencies of an answer's peaks: of several equal peaks the nearest one is reported.
struct GivenPeaks {
    std::optional<double> omega_Ms, omega_Mt;  ///< empty: at infinity, or not known
};

/// Every figure of robustness; of an unstable loop it would be meaningless. Errors: unsupported if the dead time turns
/// L too often for a dense walk.
Expected<Robustness> scan_frequencies(const LinearPlant& plant, const ParallelPid& pid, const GivenPeaks& given);

}  // namespace tunewright::verify
