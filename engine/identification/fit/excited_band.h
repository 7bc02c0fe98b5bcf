// The frequencies at which a recorded test determines the plant.
#pragma once

#include <optional>
#include <vector>

#include "engine/plant/plant.h"

namespace tunewright {

/// Angular frequencies, rad per time unit.
struct ExcitedBand {
    double omega_low = 0;   ///< 2 pi over the record's length
    double omega_high = 0;  ///< <= pi over the sample time
};

/// What the band is computed from: u held between the instants t, at `u_rest` before the first, and y's noise.
struct Excitation {
    std::vector<double> t, u;
    double u_rest = 0;
    double sample_time = 0;  ///< of y, median
    double noise_std = 0;    ///< of y, its rounding and what else no sensor resolves included
};

/// Up to `omega_high` the record's own estimate of P(j omega), the ratio of the Fourier sums of y and u, would have a
/// relative standard error below 100 %: the plant's answer |P U|^2 exceeds the noise in it, noise_std^2 sample_time T,
/// T the record's length, somewhere within 15 % of that frequency (empirical transfer function estimate: Ljung 1999,
/// section 6.3). The changes of u count, so a step that stays counts as the step it is. Empty: nothing of the kind, or
/// a plant that cannot be computed.
std::optional<ExcitedBand> excited_band(const Excitation& excitation, const Plant& plant);

}  // namespace tunewright
