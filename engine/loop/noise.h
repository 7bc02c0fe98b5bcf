// The effect of measurement noise on the controller's output.
//
//   const auto gain = noise_gain(loop, default_noise_sample_time(loop));   // 3: noise of 0.1 moves u by 0.3
#pragma once

#include <optional>

#include "engine/loop/loop.h"

namespace tunewright {

/// sigma_u/sigma_n: the standard deviation of u (root of its mean square over time) over that of white measurement
/// noise that is sampled every `sample_time` Ts > 0 and held in between. The held noise has the two-sided spectral
/// density sigma_n^2 Ts sinc^2(omega Ts/2), sinc(x) = sin(x)/x (a triangle of half-width Ts as autocorrelation), so
///
///   (sigma_u/sigma_n)^2 = Ts/pi  integral from 0 to infinity of |C S|^2 sinc^2(omega Ts/2) d omega.
///
/// The limit of |C S| at high frequency is integrated in closed form. With q = L(infinity) without the dead time's
/// turning, |C S|^2 tends to |C(inf)|^2/|1 + q e^(-j omega L)|^2, which contributes C(inf)^2/(1 - q^2) (1 + 2 sum_k
/// (-q)^k (1 - k L/Ts)), k >= 1 with k L < Ts. For a P controller with a tiny loop gain this is exactly |Kp|. The rest
/// is computed by adaptive quadrature, with a relative error below 1e-4.
///
/// The loop must be stable. Empty where the ratio is infinite: a derivative without filter. (Åström and Murray,
/// Feedback Systems, 2008, section 12, for spectra in loops; the sampled form is derived here.)
std::optional<double> noise_gain(const Loop& loop, double sample_time);

/// The default sample time: Tf/10 with a filter; else a hundredth of 2 pi over the gain crossover; else (|L| is never
/// 1) a hundredth of the plant's dead time and lags, or of 1 if it has none. > 0.
double default_noise_sample_time(const Loop& loop);

}  // namespace tunewright
