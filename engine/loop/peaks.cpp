#include "engine/loop/peaks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/numerics/extremum.h"
#include "engine/numerics/fast_complex.h"

namespace tunewright {
namespace {

using LoopFunction = std::function<LoopPoint(double)>;
using Magnitude = double (*)(const LoopPoint&);

double magnitude_S(const LoopPoint& p) { return magnitude(p.S); }
double magnitude_T(const LoopPoint& p) { return magnitude(p.T); }
double magnitude_CS(const LoopPoint& p) { return magnitude(p.CS); }
double magnitude_C(const LoopPoint& p) { return magnitude(p.CS) * magnitude(1.0 + p.L); }

constexpr double kWorthRefining = 0.8;  // of the largest grid value: neighbours on the grid differ by less than that

constexpr double kLongTurn = 0.3;        // rad of the dead time between neighbours of the grid: more hides a peak
constexpr double kTurnStep = 0.15;       // rad between two looks there
constexpr double kWorthFollowing = 0.9;  // of the highest so far
constexpr double kBetween = 1.01;        // |L| and |C| may be larger between neighbours than at both

constexpr double kHigher = 1 + 1e-12;  // a limit must exceed a peak by more than rounding to stand for it
constexpr double kLowRise = 0.3;       // of |S| - 1: below it the usual grid is too coarse for so flat a maximum
constexpr double kFinestStep = 5e-3, kUsualStep = 0.15;  // of S between neighbours

Peak interior_peak(const LoopFunction& at, const LoopGrid& grid, Magnitude magnitude) {
    const std::size_t n = grid.omega.size();
    std::vector<double> value(n);
    for (std::size_t i = 0; i < n; ++i) value[i] = magnitude(grid.point[i]);
    const auto largest = std::max_element(value.begin(), value.end());
    Peak best{*largest, grid.omega[static_cast<std::size_t>(largest - value.begin())]};
    const double threshold = kWorthRefining * *largest;
    const auto f = [&](double omega) { return magnitude(at(omega)); };
    for (std::size_t i = 1; i + 1 < n; ++i) {
        if (value[i] < threshold || value[i] < value[i - 1] || value[i] < value[i + 1]) continue;
        const auto peak = log_maximum(f, grid.omega[i - 1], {grid.omega[i], value[i]}, grid.omega[i + 1]);
        if (peak.value > best.value) best = {peak.value, peak.x};
    }
    return best;
}

/// Beyond the resolved range: |S| <= 1/(1 - |L|), reached once every turn of the dead time. Scans a few turns around
/// the places where such a bound is locally largest.
void raise_by_fast_turning(const Loop& loop, const LoopGrid& grid, Peaks& peaks) {
    const double L = loop.plant().dead_time();
    if (L == 0) return;
    const double period = 2 * std::numbers::pi / L;
    const auto scan = [&](double around, Magnitude magnitude, Peak& best) {
        const double from = std::max(around - 1.5 * period, grid.resolved_to), step = period / 24;
        const auto f = [&](double omega) { return magnitude(loop.at(omega)); };
        for (int k = 1; k < 72; ++k) {
            const double omega = from + k * step;
            const double here = f(omega);
            if (here < kWorthRefining * best.value || here < f(omega - step) || here < f(omega + step)) continue;
            const auto peak = log_maximum(f, omega - step, {omega, here}, omega + step);
            if (peak.value > best.value) best = {peak.value, peak.x};
        }
    };
    const auto raise = [&](Peak& best, Magnitude value, auto&& numerator) {
        const auto bound = [&](const LoopPoint& p) {
            const double gain = magnitude(p.L);
            return gain < 1 ? numerator(p) / (1 - gain) : 0;
        };
        const auto bound_at = [&](double omega) { return bound(loop.at(omega)); };
        double left = grid.resolved_to, before = bound_at(left);
        if (before > best.value) scan(left, value, best);
        for (std::size_t i = 1; i + 1 < grid.omega.size(); ++i) {
            if (grid.omega[i] <= left) continue;
            const double here = bound(grid.point[i]);
            if (here > before && here >= bound(grid.point[i + 1])) {
                const Maximum top = log_maximum(bound_at, left, {grid.omega[i], here}, grid.omega[i + 1]);
                if (top.value > best.value) scan(top.x, value, best);
            }
            left = grid.omega[i];
            before = here;
        }
    };
    raise(peaks.S, magnitude_S, [](const LoopPoint&) { return 1.0; });
    raise(peaks.T, magnitude_T, [](const LoopPoint& p) { return magnitude(p.L); });
    raise(peaks.CS, magnitude_CS, magnitude_C);
}

void raise(Peak& peak, double value, double omega) {
    if (value > peak.value * kHigher || (value >= peak.value && omega == 0)) peak = {value, omega};
}

void raise_by_limits(const Loop& loop, Peaks& peaks) {
    const LoopPoint zero = loop.at(0);
    raise(peaks.S, std::abs(zero.S), 0);
    raise(peaks.T, std::abs(zero.T), 0);
    if (std::isfinite(std::abs(zero.CS))) raise(peaks.CS, std::abs(zero.CS), 0);

    const double infinity = std::numeric_limits<double>::infinity(), q = loop.signed_high_frequency_gain();
    const double nearest = loop.plant().dead_time() > 0 ? 1 - std::abs(q) : std::abs(1 + q);
    raise(peaks.S, 1 / nearest, infinity);
    raise(peaks.T, std::abs(q) / nearest, infinity);
    raise(peaks.CS, std::abs(loop.controller_high_frequency_gain()) / nearest, infinity);
}

}  // namespace

LoopGrid make_peak_grid(const Loop& loop) {
    LoopGrid grid = make_loop_grid(loop);
    double largest = 0;
    for (const auto& point : grid.point) largest = std::max(largest, magnitude(point.S));
    // Where S never rises far above one, its maximum is as flat: look closer.
    const double rise = largest - 1;
    if (rise < kLowRise) grid = make_loop_grid(loop, std::clamp(kLowRise * rise, kFinestStep, kUsualStep));
    return grid;
}

Peaks find_interior_peaks(const LoopFunction& at, const LoopGrid& grid) {
    return {interior_peak(at, grid, magnitude_S), interior_peak(at, grid, magnitude_T),
            interior_peak(at, grid, magnitude_CS)};
}

Peaks find_interior_sensitivity_peak(const LoopFunction& at, const LoopGrid& grid) {
    constexpr Peak found{std::numeric_limits<double>::infinity(), 0};
    return {interior_peak(at, grid, magnitude_S), found, found};
}

Peak find_sensitivity_peak(const Loop& loop, const LoopGrid& grid) {
    Peaks peaks = find_interior_sensitivity_peak([&](double omega) { return loop.at(omega); }, grid);
    raise_by_fast_turning(loop, grid, peaks);
    raise_by_limits(loop, peaks);
    return peaks.S;
}

void raise_by_turns(const std::function<LoopPoint(double)>& at, double time, const LoopGrid& grid, Peaks& peaks) {
    const auto turn = [time](double omega) { return omega * time; };
    struct Stretch {
        double left, right, S, T, CS;  // what its peaks can be at most
    };
    std::vector<Stretch> stretches;
    for (std::size_t i = 1; i < grid.omega.size(); ++i) {
        const double left = grid.omega[i - 1], right = grid.omega[i];
        if (turn(right - left) < kLongTurn || right > grid.resolved_to) continue;
        const LoopPoint &a = grid.point[i - 1], &b = grid.point[i];
        const double gain_a = magnitude(a.L), gain_b = magnitude(b.L);
        if (!std::isfinite(gain_a) || !std::isfinite(gain_b)) continue;
        const double small = std::min(gain_a, gain_b), large = std::max(gain_a, gain_b);
        const double nearest = large < 1 ? 1 - large : std::max(0.0, small - 1);
        stretches.push_back(
            {left, right, 1 / nearest, large / nearest, std::max(magnitude_C(a), magnitude_C(b)) / nearest});
    }
    using Bound = double Stretch::*;
    const auto raise = [&](Peak& best, Bound bound, auto&& value) {
        std::sort(stretches.begin(), stretches.end(),
                  [&](const Stretch& a, const Stretch& b) { return a.*bound > b.*bound; });
        for (const Stretch& s : stretches) {
            if (s.*bound * kBetween <= best.value) return;
            const auto f = [&](double omega) { return value(at(omega)); };
            const int looks = static_cast<int>(std::ceil(turn(s.right - s.left) / kTurnStep));
            const double step = (s.right - s.left) / looks;
            double before = f(s.left - step), here = f(s.left);
            for (int k = 0; k <= looks; ++k) {
                const double omega = s.left + k * step, after = f(omega + step);
                if (here > kWorthFollowing * best.value && here >= before && here >= after) {
                    const Maximum top = log_maximum(f, omega - step, {omega, here}, omega + step);
                    if (top.value > best.value) best = {top.value, top.x};
                }
                before = here;
                here = after;
            }
        }
    };
    raise(peaks.S, &Stretch::S, [](const LoopPoint& p) { return magnitude(p.S); });
    raise(peaks.T, &Stretch::T, [](const LoopPoint& p) { return magnitude(p.T); });
    raise(peaks.CS, &Stretch::CS, [](const LoopPoint& p) { return magnitude(p.CS); });
}

Peaks find_peaks(const Loop& loop, const LoopGrid& grid) {
    const LoopFunction at = [&](double omega) { return loop.at(omega); };
    Peaks peaks = find_interior_peaks(at, grid);
    raise_by_turns(at, loop.plant().dead_time(), grid, peaks);
    raise_by_fast_turning(loop, grid, peaks);
    raise_by_limits(loop, peaks);
    return peaks;
}

}  // namespace tunewright
