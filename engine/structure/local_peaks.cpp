#include "engine/structure/local_peaks.h"

#include <algorithm>
#include <cmath>

namespace tunewright::structure {
namespace {

constexpr int kRefinements = 12;     // parabolas through three points
constexpr double kConverged = 1e-6;  // of ln omega: the value is flat there

struct Point {
    double x, value;  // x: ln omega
};

/// The maximum of the parabola through three points; the middle one where it has none.
double vertex(const Point& a, const Point& b, const Point& c) {
    const double left = (b.value - a.value) / (b.x - a.x), right = (c.value - b.value) / (c.x - b.x);
    const double bend = (right - left) / (c.x - a.x);
    if (!(bend < 0)) return b.x;
    return std::clamp(0.5 * (a.x + b.x) - 0.5 * left / bend, a.x, c.x);
}

LimitedPeak refined(const ExcessAt& excess_at, int function, Point a, Point b, Point c) {
    std::vector<double> excess;
    for (int i = 0; i < kRefinements; ++i) {
        double x = vertex(a, b, c);
        if (std::abs(x - b.x) < kConverged) {
            // Once more beside the middle, so that both sides become short.
            x = b.x + (c.x - b.x > b.x - a.x ? 1 : -1) * kConverged;
            if (c.x - a.x < 4 * kConverged) break;
        }
        excess_at(std::exp(x), excess);
        const Point next{x, excess[std::size_t(function)]};
        if (next.value > b.value) {
            (x > b.x ? a : c) = b;
            b = next;
        } else {
            (x > b.x ? c : a) = next;
        }
    }
    return {function, std::exp(b.x), b.value};
}

}  // namespace

std::vector<double> logarithmic(double low, double high, int per_decade) {
    const int n = std::max(2, static_cast<int>(std::ceil(per_decade * std::log10(high / low))));
    std::vector<double> omega;
    for (int i = 0; i <= n; ++i) omega.push_back(low * std::pow(high / low, double(i) / n));
    return omega;
}

std::vector<LimitedPeak> local_peaks(const std::vector<double>& omega, const ExcessAt& excess_at, double least) {
    std::vector<std::vector<double>> values(omega.size());
    for (std::size_t i = 0; i < omega.size(); ++i) excess_at(omega[i], values[i]);
    std::vector<LimitedPeak> peaks;
    const std::size_t last = omega.size() - 1;
    for (std::size_t k = 0; k < values.front().size(); ++k) {
        const auto point = [&](std::size_t i) { return Point{std::log(omega[i]), values[i][k]}; };
        for (std::size_t i = 0; i <= last; ++i) {
            const double here = values[i][k];
            if (!(here > least)) continue;
            if ((i > 0 && values[i - 1][k] >= here) || (i < last && values[i + 1][k] > here)) continue;
            if (i == 0 || i == last)
                peaks.push_back({int(k), omega[i], here});
            else
                peaks.push_back(refined(excess_at, int(k), point(i - 1), point(i), point(i + 1)));
        }
    }
    return peaks;
}

}  // namespace tunewright::structure
