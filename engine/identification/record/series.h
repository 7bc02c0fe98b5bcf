// Properties of a series of samples: its noise, its grid, and its number of independent samples.
#pragma once

#include <span>
#include <vector>

namespace tunewright {

/// The median magnitude of a normal variable, relative to its standard deviation.
inline constexpr double kMedianOfNormal = 0.6745;

/// Standard deviation of the part of y that changes from sample to sample: by second differences, median-based if that
/// is not 0 (a slow response does not count), else root mean square (coarse grids, where most differences are 0). 0 for
/// fewer than three samples.
double noise_std(std::span<const double> y);

/// The step of the grid that all values lie on, 0 if there is none. It comes from the steps of a converter or of
/// printed digits. With two different values it is the distance between them. `y` has at least one value.
double quantisation_step(std::span<const double> y);

/// The sum of squares of the values about their mean; `y` has at least one value.
double squares_about_mean(std::span<const double> y);

/// The integrated autocorrelation time of a series, in samples, >= 1: 1 + 2 sum rho_k, the sum ended by Geyer's initial
/// positive sequence (Geyer 1992, section 3.3), for more than 3,000 samples by means of batches. White noise has 1; n
/// samples correspond to n/(this) independent ones.
double correlation_time(std::span<const double> series);

/// The least number of independent samples of any record, because with fewer no criterion is defined.
inline constexpr double kMinIndependent = 4;

/// The number of independent samples in a residual, at least kMinIndependent.
double effective_samples(std::span<const double> residual);

}  // namespace tunewright
