#include "engine/structure/search/local_peaks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/numerics/optimise/line_search.h"

namespace tunewright::structure {
namespace {

constexpr double kTurned = 400;  // rad of the largest dead time: beyond it loops have no gain

}  // namespace

std::vector<double> logarithmic(double low, double high, int per_decade) {
    const int n = std::max(2, static_cast<int>(std::ceil(per_decade * std::log10(high / low))));
    std::vector<double> omega;
    for (int i = 0; i <= n; ++i) omega.push_back(low * std::pow(high / low, double(i) / n));
    return omega;
}

std::vector<double> frequencies_around(const std::vector<const LinearPlant*>& plants, double below, double above,
                                       int per_decade, double turn) {
    double low = std::numeric_limits<double>::infinity(), high = 0, dead_time = 0;
    const auto add = [&](double omega) {
        if (!(omega > 0) || !std::isfinite(omega)) return;
        low = std::min(low, omega);
        high = std::max(high, omega);
    };
    for (const LinearPlant* plant : plants) {
        add(1 / plant->time_scale());
        for (const auto pole : plant->poles()) add(std::abs(pole));
        add(1 / plant->dead_time());
        dead_time = std::max(dead_time, plant->dead_time());
    }
    if (!(high > 0)) low = high = 1;
    std::vector<double> omega;
    for (const double next : logarithmic(below * low, above * high, per_decade)) {
        const double before = omega.empty() ? next : omega.back(), angle = dead_time * (next - before);
        const int parts = dead_time * next < kTurned ? std::max(1, int(std::ceil(angle / turn))) : 1;
        for (int i = 1; i <= parts; ++i) omega.push_back(before + (next - before) * i / parts);
    }
    return omega;
}

std::vector<LimitedPeak> local_peaks(const std::vector<double>& omega, const ExcessAt& excess_at, double least) {
    std::vector<std::vector<double>> values(omega.size());
    for (std::size_t i = 0; i < omega.size(); ++i) excess_at(omega[i], values[i]);
    std::vector<LimitedPeak> peaks;
    const std::size_t last = omega.size() - 1;
    for (std::size_t k = 0; k < values.front().size(); ++k) {
        const auto function = [&, excess = std::vector<double>()](double at) mutable {
            excess_at(at, excess);
            return excess[k];
        };
        for (std::size_t i = 0; i <= last; ++i) {
            const double here = values[i][k];
            if (!(here > least)) continue;
            if ((i > 0 && values[i - 1][k] >= here) || (i < last && values[i + 1][k] > here)) continue;
            Maximum peak{omega[i], here};
            if (i > 0 && i < last) peak = log_maximum(function, omega[i - 1], peak, omega[i + 1]);
            peaks.push_back({int(k), peak.x, peak.value});
        }
    }
    return peaks;
}

}  // namespace tunewright::structure
