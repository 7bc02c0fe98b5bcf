#include "engine/numerics/fourier.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <unsupported/Eigen/FFT>

#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

constexpr std::size_t kMostKept = 1 << 19;  // values of all lengths whose factors are kept: 8 MB

/// Transforms of length n. The trigonometric factors of the last lengths are kept for the thread: they cost as much as
/// a transform.
Eigen::FFT<double>& transform(std::size_t n) {
    thread_local Eigen::FFT<double> fft;
    thread_local std::vector<std::size_t> lengths;
    if (std::ranges::find(lengths, n) == lengths.end()) {
        if (std::accumulate(lengths.begin(), lengths.end(), n) > kMostKept) {
            fft = {};
            lengths.clear();
        }
        fft.SetFlag(Eigen::FFT<double>::HalfSpectrum);
        lengths.push_back(n);
    }
    return fft;
}

/// The deviations from the mean, followed by zeros, so that no lag up to `longest` meets the series' other end.
std::vector<double> padded(std::span<const double> x, std::size_t longest) {
    const double centre = mean(x);
    // The transform of real series by halves needs an even length.
    std::size_t n = quick_length(x.size() + longest);
    while (n % 2 != 0) n = quick_length(n + 1);
    std::vector<double> out(n, 0.0);
    std::ranges::transform(x, out.begin(), [=](double value) { return value - centre; });
    return out;
}

}  // namespace

std::size_t quick_length(std::size_t n) {
    for (;; ++n) {
        std::size_t rest = n;
        for (const std::size_t factor : {2U, 3U, 5U})
            while (rest > 1 && rest % factor == 0) rest /= factor;
        if (rest <= 1) return n;
    }
}

std::vector<std::complex<double>> half_spectrum(std::span<const double> x) {
    std::vector<std::complex<double>> X;
    if (x.size() < 2) return {x.begin(), x.end()};
    const std::vector<double> in(x.begin(), x.end());
    transform(in.size()).fwd(X, in);
    return X;
}

std::vector<double> series_of(std::span<const std::complex<double>> X, std::size_t n) {
    std::vector<double> x;
    if (n < 2) {
        for (const auto& value : X.first(n)) x.push_back(value.real());
        return x;
    }
    const std::vector<std::complex<double>> in(X.begin(), X.end());
    transform(n).inv(x, in, static_cast<Eigen::Index>(n));
    x.resize(n);
    return x;
}

std::vector<double> autocorrelation(std::span<const double> x, std::size_t longest) {
    const auto in = padded(x, longest);
    auto X = half_spectrum(in);
    for (auto& value : X) value = std::norm(value);
    auto r = series_of(X, in.size());
    r.resize(longest + 1);
    const double variance = r.front();
    if (!(variance > 0)) {
        std::ranges::fill(r, 0.0);
        r.front() = 1;
        return r;
    }
    for (double& value : r) value /= variance;
    return r;
}

std::vector<double> crosscorrelation(std::span<const double> a, std::span<const double> b, std::size_t longest) {
    const auto first = padded(a, longest), second = padded(b, longest);
    const auto A = half_spectrum(first);
    auto B = half_spectrum(second);
    double power_a = 0, power_b = 0;
    for (const double value : first) power_a += value * value;
    for (const double value : second) power_b += value * value;
    std::vector<double> c(2 * longest + 1, 0.0);
    if (!(power_a > 0 && power_b > 0)) return c;
    for (std::size_t k = 0; k < B.size(); ++k) B[k] *= std::conj(A[k]);
    const auto all = series_of(B, first.size());
    const double scale = 1 / std::sqrt(power_a * power_b);
    for (std::size_t k = 0; k <= longest; ++k) {
        c[longest + k] = scale * all[k];
        if (k > 0) c[longest - k] = scale * all[all.size() - k];
    }
    return c;
}

}  // namespace tunewright
