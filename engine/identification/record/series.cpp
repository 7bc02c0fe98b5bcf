#include "engine/identification/record/series.h"

#include <Eigen/Core>
#include <algorithm>
#include <boost/sort/spreadsort/float_sort.hpp>
#include <cmath>
#include <numeric>

#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

/// By Geyer's sum, for up to a few thousand samples.
double summed_correlation_time(std::span<const double> series) {
    const int n = static_cast<int>(series.size());
    const int longest = std::min(n / 2, 2000);
    const Eigen::Map<const Eigen::VectorXd> values(series.data(), n);
    const auto covariance = [&](int lag) { return values.tail(n - lag).dot(values.head(n - lag)); };
    const double variance = covariance(0);
    if (!(variance > 0)) return 1;
    double time = -1;
    for (int k = 0; k + 1 <= longest; k += 2) {
        const double pair = (k == 0 ? variance : covariance(k)) + covariance(k + 1);
        if (pair <= 0) break;
        time += 2 * pair / variance;
    }
    return std::max(1.0, time);
}

}  // namespace

double noise_std(std::span<const double> y) {
    // A second difference of white noise has six times its variance.
    std::vector<double> differences;
    double squares = 0;
    for (std::size_t i = 2; i < y.size(); ++i) {
        const double d = y[i] - 2 * y[i - 1] + y[i - 2];
        differences.push_back(std::abs(d));
        squares += d * d;
    }
    if (differences.empty()) return 0;
    const double by_square = std::sqrt(squares / static_cast<double>(differences.size()) / 6);
    const double by_median = median(std::move(differences)) / kMedianOfNormal / std::sqrt(6.0);
    return by_median > 0 ? std::min(by_median, by_square) : by_square;
}

double quantisation_step(std::span<const double> y) {
    std::vector<double> values(y.begin(), y.end());
    boost::sort::spreadsort::float_sort(values.begin(), values.end());
    const double range = values.back() - values.front();
    constexpr double kEqualTolerance =
        1e-9;                            // values this close, relative to the largest, differ only by binary rounding
    constexpr double kMaxOffGrid = 0.1;  // of a step: printed digits and converters are closer to their grid
    const double same = kEqualTolerance * std::max(range, std::max(std::abs(values.front()), std::abs(values.back())));
    values.erase(std::unique(values.begin(), values.end(), [&](double a, double b) { return b - a <= same; }),
                 values.end());
    if (values.size() == 2) return range;
    if (values.size() < 3) return 0;
    double smallest = range;
    for (std::size_t i = 1; i < values.size(); ++i) smallest = std::min(smallest, values[i] - values[i - 1]);
    double count = 0;
    for (std::size_t i = 1; i < values.size(); ++i) count += std::round((values[i] - values[i - 1]) / smallest);
    const double step = range / count;
    for (double value : values) {
        const double places = (value - values.front()) / step;
        if (std::abs(places - std::round(places)) > kMaxOffGrid) return 0;
    }
    return step;
}

double squares_about_mean(std::span<const double> y) {
    const double mean = std::accumulate(y.begin(), y.end(), 0.0) / static_cast<double>(y.size());
    double squares = 0;
    for (const double value : y) squares += (value - mean) * (value - mean);
    return squares;
}

double correlation_time(std::span<const double> series) {
    constexpr std::size_t kMaxSummed = 3000;
    if (series.size() <= kMaxSummed) return summed_correlation_time(series);
    // Means of batches: their variance contains the correlation inside them, the sum over batches the rest.
    const std::size_t batch = (series.size() + kMaxSummed - 1) / kMaxSummed;
    std::vector<double> means;
    double squares = 0;
    for (std::size_t i = 0; i + batch <= series.size(); i += batch) {
        double sum = 0;
        for (std::size_t k = i; k < i + batch; ++k) {
            sum += series[k];
            squares += series[k] * series[k];
        }
        means.push_back(sum / static_cast<double>(batch));
    }
    double between = 0;
    for (const double mean : means) between += mean * mean;
    if (!(squares > 0)) return 1;
    const auto size = static_cast<double>(batch);
    return std::max(1.0, size * size * between / squares * summed_correlation_time(means));
}

double effective_samples(std::span<const double> residual) {
    return std::max(kMinIndependent, static_cast<double>(residual.size()) / correlation_time(residual));
}

}  // namespace tunewright
