// The discrete Fourier transform of real series, and what follows from it: power over frequency, autocorrelation.
#pragma once

#include <complex>
#include <span>
#include <vector>

namespace tunewright {

/// The smallest number of at least n whose prime factors are 2, 3 and 5: a transform of that length is quick.
std::size_t quick_length(std::size_t n);

/// X_k = sum x_j exp(-2 pi i j k/n), k = 0 ... n/2.
std::vector<std::complex<double>> half_spectrum(std::span<const double> x);

/// The real series of n values whose half spectrum is X.
std::vector<double> series_of(std::span<const std::complex<double>> X, std::size_t n);

/// r_k = sum (x_j - mean)(x_{j+k} - mean) / sum (x_j - mean)^2 for lags 0 ... longest, the sums over the pairs that
/// exist (biased estimate, Box and Jenkins 1976, Eq. 2.1.8); all 0 but the first for a constant series. longest <
/// x.size().
std::vector<double> autocorrelation(std::span<const double> x, std::size_t longest);

/// c_k = sum over j of (a_j - mean)(b_{j+k} - mean) / n over the deviations' product, for lags -longest ... longest, in
/// this order; 0 for a constant series. Equal lengths.
std::vector<double> crosscorrelation(std::span<const double> a, std::span<const double> b, std::size_t longest);

}  // namespace tunewright
