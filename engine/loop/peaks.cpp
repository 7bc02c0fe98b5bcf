#include "engine/loop/peaks.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/numerics/fast_complex.h"
#include "engine/numerics/optimise/line_search.h"

namespace tunewright {
namespace {

using Magnitude = double (*)(const LoopPoint&);

double magnitude_S(const LoopPoint& p) { return magnitude(p.S); }
double magnitude_T(const LoopPoint& p) { return magnitude(p.T); }
double magnitude_CS(const LoopPoint& p) { return magnitude(p.CS); }
double magnitude_C(const LoopPoint& p) { return magnitude(p.CS) * magnitude(1.0 + p.L); }

constexpr double kMinShareOfMaximum =
    0.8;  // of the largest grid value: a lower point is not a candidate, because neighbours on the grid differ by less

constexpr double kLongTurn = 0.3;  // rad of the dead time between neighbours of the grid: a longer turn may hide a peak
// rad between two evaluations there. For small |L| the maxima along a turn are as wide as those of a sine.
constexpr double kTurnStep = 0.15, kMaxSmallModulus = 0.3, kTurnStepOfSmall = 0.5;
constexpr double kPlainTurn = 1;  // rad: for shorter turns both ends bound the distance of L from -1 between them
constexpr double kMaxModulusRiseBetween = 0.01;  // relative rise of |L| and |C| between neighbours

constexpr double kMinPeakRatio = 1 + 1e-12;  // a limit must exceed a peak by more than rounding to count as the peak
constexpr double kMaxLowRise = 0.3;          // of |S| - 1: below it the usual grid is too coarse for so flat a maximum
constexpr double kFinestStep = 5e-3, kUsualStep = 0.15;  // change of S between neighbours

Peak interior_peak(const AnyLoop& loop, const LoopGrid& grid, Magnitude magnitude) {
    const std::size_t n = grid.omega.size();
    std::vector<double> value(n);
    for (std::size_t i = 0; i < n; ++i) value[i] = magnitude(grid.point[i]);
    const auto largest = std::max_element(value.begin(), value.end());
    Peak best{*largest, grid.omega[static_cast<std::size_t>(largest - value.begin())]};
    const double threshold = kMinShareOfMaximum * *largest;
    const auto f = [&](double omega) { return magnitude(loop.at(omega)); };
    const auto point = [&](std::size_t i) -> Maximum { return {grid.omega[i], value[i]}; };
    const auto refine = [&](std::size_t i) {
        const auto peak = log_maximum(f, grid.omega[i - 1], point(i), grid.omega[i + 1]);
        if (peak.value > best.value) best = {peak.value, peak.x};
    };
    const auto highest = static_cast<std::size_t>(largest - value.begin());
    if (highest > 0 && highest + 1 < n) refine(highest);
    for (std::size_t i = 1; i + 1 < n; ++i) {
        if (value[i] < threshold || value[i] < value[i - 1] || value[i] < value[i + 1] || i == highest) continue;
        if (may_exceed(best.value, point(i - 1), point(i), point(i + 1))) refine(i);
    }
    return best;
}

/// Beyond the resolved range: |S| <= 1/(1 - |L|), a bound that is reached once in every turn of the dead time. Scans a
/// few turns around the local maxima of such a bound.
void raise_by_fast_turning(const AnyLoop& loop, const LoopGrid& grid, Peaks& peaks) {
    const double L = loop.turning_time;
    if (L == 0 || loop.ends.omega.empty() || std::isfinite(loop.ends.omega.back())) return;
    const double period = 2 * std::numbers::pi / L;
    const auto scan = [&](double around, Magnitude magnitude, Peak& best) {
        const double from = std::max(around - 1.5 * period, grid.resolved_to), step = period / 24;
        const auto f = [&](double omega) { return magnitude(loop.at(omega)); };
        for (int k = 1; k < 72; ++k) {
            const double omega = from + k * step;
            const double here = f(omega);
            if (here < kMinShareOfMaximum * best.value || here < f(omega - step) || here < f(omega + step)) continue;
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

void raise_by_ends(const AnyLoop& loop, Peaks& peaks) {
    for (std::size_t i = 0; i < loop.ends.omega.size(); ++i) {
        const double omega = loop.ends.omega[i];
        const auto raise = [&](Peak& peak, double value) {
            if (value > peak.value * kMinPeakRatio || (value >= peak.value && omega == 0)) peak = {value, omega};
        };
        raise(peaks.S, magnitude_S(loop.ends.point[i]));
        raise(peaks.T, magnitude_T(loop.ends.point[i]));
        raise(peaks.CS, magnitude_CS(loop.ends.point[i]));
    }
}

/// Interval between neighbours of the grid in which the dead time turns L so far that a peak can hide.
struct Stretch {
    double left, right;
    double S, T, CS;             // upper bounds of its peaks, from |L| and |C| at both ends
    double change_S, change_CS;  // relative change of these bounds from end to end
    double step;                 // rad between two evaluations
};

std::vector<Stretch> stretches_of(const LoopGrid& grid, double time) {
    std::vector<Stretch> stretches;
    for (std::size_t i = 1; i < grid.omega.size(); ++i) {
        const double left = grid.omega[i - 1], right = grid.omega[i];
        if (time * (right - left) < kLongTurn || right > grid.resolved_to) continue;
        const LoopPoint &a = grid.point[i - 1], &b = grid.point[i];
        const double gain_a = magnitude(a.L), gain_b = magnitude(b.L);
        if (!std::isfinite(gain_a) || !std::isfinite(gain_b)) continue;
        const double small = std::min(gain_a, gain_b), large = std::max(gain_a, gain_b);
        double nearest = large < 1 ? 1 - large : std::max(0.0, small - 1);
        if (time * (right - left) < kPlainTurn) nearest = std::max(nearest, nearest_between(a.L, b.L));
        const double C_a = magnitude_C(a), C_b = magnitude_C(b), C = std::max(C_a, C_b);
        const double change = (large - small) / nearest;
        stretches.push_back({.left = left,
                             .right = right,
                             .S = 1 / nearest,
                             .T = large / nearest,
                             .CS = C / nearest,
                             .change_S = change,
                             .change_CS = change + std::abs(C_a - C_b) / C,
                             .step = large < kMaxSmallModulus ? kTurnStepOfSmall : kTurnStep});
    }
    return stretches;
}

/// Adds to the bounds the amount by which |L| and |C| may be larger within an interval than at its ends: their change
/// there and in the neighbouring intervals.
void give_room(std::vector<Stretch>& stretches) {
    const auto room = [&](std::size_t i, double Stretch::*change) {
        if (i == 0 || i + 1 == stretches.size()) return kMaxModulusRiseBetween;
        const Stretch &before = stretches[i - 1], &here = stretches[i], &after = stretches[i + 1];
        if (before.right != here.left || here.right != after.left) return kMaxModulusRiseBetween;
        const double max = std::max({before.*change, here.*change, after.*change});
        return max < kMaxModulusRiseBetween ? max : kMaxModulusRiseBetween;
    };
    for (std::size_t i = 0; i < stretches.size(); ++i) {
        stretches[i].S *= 1 + room(i, &Stretch::change_S);
        stretches[i].T *= 1 + kMaxModulusRiseBetween;
        stretches[i].CS *= 1 + room(i, &Stretch::change_CS);
    }
}

/// Evaluates along the interval, step by step and at those local maxima that may exceed the peak so far.
void scan_peak(const Stretch& s, double time, const std::function<double(double)>& f, Peak& best) {
    constexpr double kMaxEvaluations = 1e8;
    const int evaluations = static_cast<int>(std::min(std::ceil(time * (s.right - s.left) / s.step), kMaxEvaluations));
    const double step = (s.right - s.left) / evaluations;
    Maximum before{s.left - step, f(s.left - step)}, here{s.left, f(s.left)};
    for (int k = 0; k <= evaluations; ++k) {
        const double next = s.left + (k + 1) * step;
        const Maximum after{next, f(next)};
        const bool top = here.value >= before.value && here.value >= after.value;
        if (top && may_exceed(best.value, before, here, after)) {
            const Maximum highest = log_maximum(f, before.x, here, after.x);
            if (highest.value > best.value) best = {highest.value, highest.x};
        }
        before = here;
        here = after;
    }
}

/// |1 + L| is at least |1 - |L||, and near its values at both ends where the turn is short.
void raise_by_turns(const AnyLoop& loop, const LoopGrid& grid, Peaks& peaks) {
    const double time = loop.turning_time;
    std::vector<Stretch> stretches = stretches_of(grid, time);
    give_room(stretches);
    std::vector<const Stretch*> higher;
    const auto raise = [&](Peak& best, double Stretch::*bound, Magnitude value) {
        higher.clear();
        for (const Stretch& s : stretches)
            if (s.*bound > best.value) higher.push_back(&s);
        std::ranges::sort(higher, std::greater(), [&](const Stretch* s) { return s->*bound; });
        const auto f = [&](double omega) { return value(loop.at(omega)); };
        for (const Stretch* s : higher) {
            if (s->*bound <= best.value) return;
            scan_peak(*s, time, f, best);
        }
    };
    raise(peaks.S, &Stretch::S, magnitude_S);
    raise(peaks.T, &Stretch::T, magnitude_T);
    raise(peaks.CS, &Stretch::CS, magnitude_CS);
}

/// Beginning with those within the grid.
Peaks raised(Peaks peaks, const AnyLoop& loop, const LoopGrid& grid) {
    raise_by_ends(loop, peaks);  // first, because a higher known peak leaves fewer candidates
    raise_by_turns(loop, grid, peaks);
    raise_by_fast_turning(loop, grid, peaks);
    return peaks;
}

}  // namespace

Peaks find_peaks(const AnyLoop& loop, const LoopGrid& grid) {
    return raised({interior_peak(loop, grid, magnitude_S), interior_peak(loop, grid, magnitude_T),
                   interior_peak(loop, grid, magnitude_CS)},
                  loop, grid);
}

Peak find_sensitivity_peak(const AnyLoop& loop, const LoopGrid& grid) {
    constexpr Peak highest{std::numeric_limits<double>::infinity(), 0};  // which nothing raises
    return raised({interior_peak(loop, grid, magnitude_S), highest, highest}, loop, grid).S;
}

LoopGrid refined_at_low_peak(const AnyLoop& loop, LoopGrid grid, double enough_below) {
    double largest = 0;
    for (const auto& point : grid.point) largest = std::max(largest, magnitude(point.S));
    const double rise = largest - 1;
    if (rise >= kMaxLowRise) return grid;
    return refined_grid(loop.at, grid, {std::clamp(kMaxLowRise * rise, kFinestStep, kUsualStep), enough_below});
}

}  // namespace tunewright
