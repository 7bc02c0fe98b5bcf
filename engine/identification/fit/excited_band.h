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

/// The data for the band: u, constant between the times t and equal to `u_rest` before the first, and the noise of y.
struct Excitation {
    std::vector<double> t, u;
    double u_rest = 0;
    double sample_time = 0;  ///< of y, median
    double noise_std = 0;    ///< of y, with its rounding and the least error of any sensor
};

/// Up to `omega_high` the record's own estimate of P(j omega), the ratio of the Fourier sums of y and u, would have a
/// relative standard error below 100 %: the plant's response |P U|^2 exceeds its noise, noise_std^2 sample_time T, T
/// the record's length, somewhere within 15 % of that frequency (empirical transfer function estimate: Ljung 1999,
/// section 6.3). U is computed from the changes of u, so a lasting step counts as a step. Empty: there is no such
/// frequency, or the plant cannot be evaluated.
std::optional<ExcitedBand> excited_band(const Excitation& excitation, const Plant& plant);

}  // namespace tunewright
