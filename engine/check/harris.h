// What part of a loop's variance no controller can avoid, because of the dead time.
#pragma once

#include <span>
#include <vector>

namespace tunewright::check {

/// The minimum variance over the variance of `error` for a dead time of `delays[k]` whole samples (at least 1: the
/// sample of the answer), from the impulse response of an autoregressive model (Harris 1989, Canadian Journal of
/// Chemical Engineering 67, 856; Desborough and Harris 1992, the same 70, 1186): sum_{j<b} psi_j^2 / sum psi_j^2.
struct HarrisIndex {
    std::vector<double> by_delay;  ///< of `delays`
    double low = 0, high = 0;      ///< over the delays, widened by the error of the estimate
};

/// `delays` ascend and are at most a fifth of the samples.
HarrisIndex harris_index(std::span<const double> error, std::span<const int> delays);

}  // namespace tunewright::check
