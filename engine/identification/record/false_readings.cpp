#include "engine/identification/record/false_readings.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tunewright {
namespace {

constexpr std::size_t kMin = 12;

double median_of_five(std::span<const double> y, std::size_t middle) {
    double v[5] = {y[middle - 2], y[middle - 1], y[middle], y[middle + 1], y[middle + 2]};
    std::nth_element(v, v + 2, v + 5);
    return v[2];
}

/// The value that stands apart; NaN if none does.
double number_apart(std::span<const double> y) {
    constexpr double kApart = 5;
    double low = y[0], high = y[0];
    for (const double value : y) low = std::min(low, value), high = std::max(high, value);
    double next_low = high, next_high = low;
    std::size_t lows = 0, highs = 0;
    for (const double value : y) {
        if (value > low) next_low = std::min(next_low, value);
        if (value < high) next_high = std::max(next_high, value);
        lows += value == low ? 1 : 0;
        highs += value == high ? 1 : 0;
    }
    const double others_low = high - next_low, others_high = next_high - low;
    if (others_low > 0 && next_low - low > kApart * others_low && 2 * lows < y.size()) return low;
    if (others_high > 0 && high - next_high > kApart * others_high && 2 * highs < y.size()) return high;
    return std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::size_t> spikes(std::span<const double> y) {
    const std::size_t n = y.size();
    std::vector<double> away(n, 0);
    double low = y[2], high = y[2];
    for (std::size_t i = 2; i + 2 < n; ++i) {
        const double smooth = median_of_five(y, i);
        low = std::min(low, smooth);
        high = std::max(high, smooth);
        away[i] = std::abs(y[i] - smooth);
    }
    constexpr double kUsual = 0.9, kTimesUsual = 10, kOfRange = 0.25, kAgree = 0.3;
    std::vector<double> sorted = away;
    const auto usual = sorted.begin() + static_cast<std::ptrdiff_t>(kUsual * static_cast<double>(n - 1));
    std::nth_element(sorted.begin(), usual, sorted.end());
    const double limit = std::max(kTimesUsual * *usual, kOfRange * (high - low));
    if (high <= low) return {};
    std::vector<std::size_t> found;
    for (std::size_t i = 2; i + 2 < n; ++i) {
        if (away[i] <= limit) continue;
        const std::size_t last = away[i + 1] > limit ? i + 1 : i;
        if (last + 2 >= n || away[last + 1] > limit) {
            while (i + 1 < n && away[i + 1] > limit) ++i;
            continue;
        }
        if (std::abs(y[i - 1] - y[last + 1]) < kAgree * away[i]) {
            for (std::size_t k = i; k <= last; ++k) found.push_back(k);
        }
        i = last;
    }
    const std::size_t most = std::max<std::size_t>(3, n / 100);
    return found.size() <= most ? found : std::vector<std::size_t>{};
}

}  // namespace

std::vector<std::size_t> false_readings(std::span<const double> y) {
    if (y.size() < kMin) return {};
    const double apart = number_apart(y);
    if (std::isnan(apart)) return spikes(y);
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < y.size(); ++i) {
        if (y[i] == apart) found.push_back(i);
    }
    return found;
}

}  // namespace tunewright
