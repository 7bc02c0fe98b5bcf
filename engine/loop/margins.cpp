// Margins of a loop whose dead time turns L any number of times between two points of its grid.
//
// 1. Between neighbours that a dead time turns by less than a radian, L crosses the real axis and the unit circle at
//    most once: where its sign, or |L| - 1, changes.
// 2. Where it turns by more, crossings of the real axis lie 2 pi/delay apart, along a |L| that rises or falls. The
//    nearest to -1 is the first one next to |L| = 1; if |L| does not pass 1 it is the first one next to the largest
//    |L|: a maximum between three points of the grid, else the end with the larger |L|.
// 3. From there L is evaluated in both directions, at every quarter of a radian of the dead time, until it crosses the
//    real axis on the negative side; that crossing is located to rounding.
// 4. Intervals in which |L| is smaller than at a known crossing are skipped.
#include "engine/loop/margins.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/loop/stability.h"
#include "engine/numerics/fast_complex.h"
#include "engine/numerics/optimise/line_search.h"
#include "engine/numerics/sign_change.h"

namespace tunewright {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPi = std::numbers::pi;
constexpr double kLogFrequencyTolerance = 1e-13;  // of ln omega
constexpr double kMaxModulusRatioBetween = 1.05;  // of |L| between neighbours, relative to the larger of both
constexpr double kMaxSingleCrossingTurn =
    1;  // rad of the dead time between neighbours: beyond it L may cross the axis more than once
constexpr double kStride = 0.25;   // rad of the dead time between two evaluations of L
constexpr int kMaxStrides = 1000;  // a turn of the dead time has 26; the lags turn L as well

constexpr double kFirstGain = 1.02, kGainRatio = 1.15, kLastGain = 1e3;  // of 1/K, tried for an unstable plant
constexpr std::array<double, 3> kStartGains = {0.2, 0.01, 1e-4};  // multiples of 1/K: the first stable one is used
constexpr double kMaxTurn = 0.25;                                 // rad of d between two frequencies that are evaluated
constexpr int kMaxParts = 200;  // between two points of the grid, for a d much longer than the loop's time scale
constexpr double kMinModulusOfT = 0.5;      // |T|: below it |T| |e^(-jwd) - 1| cannot reach 1
constexpr double kEdgeTolerance = 1e-13;    // relative tolerance of the frequency at which |T| passes 1/2
constexpr double kMinShareOfMaximum = 0.9;  // of the largest value so far: a lower grid point is not the top of a peak
constexpr double kMinRelevantShare = 0.45;  // of the largest value so far: at lower values 2 |T| cannot reach it

/// The frequency at which L crosses the real axis, between two frequencies that enclose it.
double real_crossing(const AnyLoop& loop, double left, double right, std::complex<double> a, std::complex<double> b) {
    const auto imaginary = [&](double omega) {
        const auto L = loop.at(omega).L;
        return L.imag() / magnitude(L);
    };
    return log_root(imaginary, left, right, a.imag() / magnitude(a), b.imag() / magnitude(b), kLogFrequencyTolerance);
}

/// The frequency at which |L| = 1, between two frequencies that enclose it.
double unit_crossing(const AnyLoop& loop, double left, double right, std::complex<double> a, std::complex<double> b) {
    const auto log_gain = [&](double omega) { return std::log(magnitude(loop.at(omega).L)); };
    return log_root(log_gain, left, right, std::log(magnitude(a)), std::log(magnitude(b)), kLogFrequencyTolerance);
}

/// L is `real` at some frequency, perhaps at an end of the axis: the factor -1/L brings it to -1.
void note_real_crossing(Margins& margins, double real, double omega) {
    if (!(real < 0)) return;
    const double factor = -1 / real;
    if (factor > 1 && factor < margins.gain_margin) {
        margins.gain_margin = factor;
        margins.phase_crossover = omega;
    }
    if (factor < 1 && factor > margins.gain_margin_low) {
        if (margins.gain_margin == kInfinity) margins.phase_crossover = omega;
        margins.gain_margin_low = factor;
    }
}

/// Notes the first frequency on the way at which L is negative. If |L| falls or rises all the way from 1, or from its
/// maximum, no later one is as near to -1.
void note_first_crossing(Margins& margins, const AnyLoop& loop, double from, double to) {
    const double stride = std::copysign(kStride / loop.turning_time, to - from);
    auto a = loop.at(from).L;
    for (int i = 0; i < kMaxStrides && from != to; ++i) {
        const bool last = (from + stride - to) * stride >= 0;
        const double next = last ? to : from + stride;
        const auto b = loop.at(next).L;
        if ((a.imag() < 0) != (b.imag() < 0) && a.real() + b.real() < 0) {
            const double omega =
                from < next ? real_crossing(loop, from, next, a, b) : real_crossing(loop, next, from, b, a);
            return note_real_crossing(margins, loop.at(omega).L.real(), omega);
        }
        from = next;
        a = b;
    }
}

/// Between the grid's points i - 1 and i, where the dead time turns L often: of all crossings those nearest to -1. They
/// lie next to |L| = 1, else next to the largest |L|.
void note_crossings_of_turns(Margins& margins, const AnyLoop& loop, const LoopGrid& grid, std::size_t i) {
    const auto gain = [&](std::size_t k) { return magnitude(grid.point[k].L); };
    const double left = grid.omega[i - 1], right = grid.omega[i];
    const std::size_t larger = gain(i - 1) >= gain(i) ? i - 1 : i;
    double from = grid.omega[larger];
    if ((gain(i - 1) < 1) != (gain(i) < 1)) {
        from = unit_crossing(loop, left, right, grid.point[i - 1].L, grid.point[i].L);
    } else if (larger > 0 && larger + 1 < grid.omega.size() && gain(larger) >= gain(larger - 1) &&
               gain(larger) >= gain(larger + 1)) {
        const auto f = [&](double omega) { return magnitude(loop.at(omega).L); };
        const double top = log_maximum(f, grid.omega[larger - 1], {from, gain(larger)}, grid.omega[larger + 1]).x;
        if (top > left && top < right) from = top;
    }
    if (from > left) note_first_crossing(margins, loop, from, left);
    if (from < right) note_first_crossing(margins, loop, from, right);
}

void note_unit_crossing(Margins& margins, std::complex<double> L, double omega) {
    double lag = std::arg(L) + kPi;  // from -1 counter-clockwise to L: the additional lag that brings L to -1, in [0, 2
                                     // pi)
    if (lag >= 2 * kPi) lag -= 2 * kPi;
    const double distance = std::min(lag, 2 * kPi - lag);
    if (distance < margins.phase_margin) {
        margins.phase_margin = distance;
        margins.gain_crossover = omega;
    }
    margins.delay_margin = std::min(margins.delay_margin, lag / omega);
}

}  // namespace

Margins find_margins(const AnyLoop& loop, const LoopGrid& grid) {
    Margins margins{kInfinity, 0, kInfinity, kInfinity, 0, 0};
    for (std::size_t i = 1; i < grid.omega.size(); ++i) {
        const auto a = grid.point[i - 1].L, b = grid.point[i].L;
        const double left = grid.omega[i - 1], right = grid.omega[i];
        if (!std::isfinite(magnitude(a)) || !std::isfinite(magnitude(b))) continue;
        // A crossing nearer to 0 than a known one does not change the margins.
        const bool counts =
            kMaxModulusRatioBetween * std::max(magnitude(a), magnitude(b)) > std::min(1.0, 1 / margins.gain_margin);
        if (counts && loop.turning_time * (right - left) > kMaxSingleCrossingTurn) {
            note_crossings_of_turns(margins, loop, grid, i);
        } else if (counts && (a.imag() < 0) != (b.imag() < 0) && (a.real() < 0 || b.real() < 0)) {
            const double omega = real_crossing(loop, left, right, a, b);
            note_real_crossing(margins, loop.at(omega).L.real(), omega);
        }
        if ((magnitude(a) < 1) != (magnitude(b) < 1)) {
            const double omega = unit_crossing(loop, left, right, a, b);
            note_unit_crossing(margins, loop.at(omega).L, omega);
        }
    }
    for (std::size_t i = 0; i < loop.ends.omega.size(); ++i) {
        const double omega = loop.ends.omega[i], L = loop.ends.point[i].L.real();
        note_real_crossing(margins, L, omega);
        if (omega == kInfinity && std::abs(L) > 1) margins.delay_margin = 0;
    }
    return margins;
}

namespace {

std::optional<UltimatePoint> from_stable_gain(const LinearPlant& plant, double Kp) {
    ParallelPid gains;
    gains.Kp = Kp;
    const auto loop = Loop::make(plant, gains);
    if (!loop || !count_unstable_poles(*loop).stable()) return std::nullopt;
    const Margins margins = find_margins(*loop, make_loop_grid(*loop));
    if (!std::isfinite(margins.gain_margin) || !(margins.phase_crossover > 0)) return std::nullopt;
    return UltimatePoint{Kp * margins.gain_margin, 2 * std::numbers::pi / margins.phase_crossover};
}

}  // namespace

std::optional<UltimatePoint> ultimate_point(const LinearPlant& plant) {
    const double unit = 1 / plant.low_frequency_gain();
    if (!std::isfinite(unit)) return std::nullopt;
    if (plant.unstable_poles() > 0) {
        // Both signs, from weak to strong: a plant with an unstable pole is stabilised between two gains, if at all.
        for (const double sign : {-1.0, 1.0}) {
            for (double factor = kFirstGain; factor < kLastGain; factor *= kGainRatio) {
                if (auto point = from_stable_gain(plant, sign * factor * unit)) return point;
            }
        }
        return std::nullopt;
    }
    // An integrating plant has no static gain as a unit: the unit is the gain whose slope over the plant's time is one.
    const double time = plant.integrators() > 0 ? plant.dead_time() + plant.lag_sum() : 1;
    if (!(time > 0)) return std::nullopt;
    for (const double factor : kStartGains) {
        if (auto point = from_stable_gain(plant, factor * unit / std::pow(time, plant.integrators()))) return point;
    }
    return std::nullopt;
}

namespace {

/// 1/d at one frequency: 0 if |T| is too small to matter.
double inverse_tolerance(double omega, double gain) {
    return gain < kMinModulusOfT ? 0 : omega / (2 * std::asin(0.5 / gain));
}

/// The frequency at which |T| passes 1/2 between neighbouring points i and k of the grid.
double band_edge(const Loop& loop, const LoopGrid& grid, std::size_t i, std::size_t k) {
    const auto gain = [&](std::size_t at) { return std::abs(grid.point[at].T) - kMinModulusOfT; };
    return log_root([&](double omega) { return std::abs(loop.at(omega).T) - kMinModulusOfT; }, grid.omega[i],
                    grid.omega[k], gain(i), gain(k), kEdgeTolerance);
}

}  // namespace

double small_gain_dead_time(const Loop& loop, const LoopGrid& grid) {
    const double q = loop.high_frequency_gain();
    if (q >= kMinModulusOfT * (1 - q)) return 0;
    const auto f = [&](double omega) { return inverse_tolerance(omega, std::abs(loop.at(omega).T)); };
    const auto value = [&](std::size_t i) { return inverse_tolerance(grid.omega[i], std::abs(grid.point[i].T)); };
    double largest = 0;
    for (std::size_t i = 1; i + 1 < grid.omega.size(); ++i) {
        const double left = value(i - 1), here = value(i), right = value(i + 1);
        if (here == 0) continue;
        if (left == 0) largest = std::max(largest, std::numbers::inv_pi * band_edge(loop, grid, i, i - 1));
        if (right == 0) largest = std::max(largest, std::numbers::inv_pi * band_edge(loop, grid, i, i + 1));
        if (left == 0 || right == 0) largest = std::max(largest, here);
        if (here >= left && here >= right && left > 0 && right > 0)
            largest =
                std::max(largest, log_maximum(f, grid.omega[i - 1], {grid.omega[i], here}, grid.omega[i + 1]).value);
    }
    return largest > 0 ? 1 / largest : std::numeric_limits<double>::infinity();
}

double dead_time_mismatch(const Loop& loop, const LoopGrid& grid, double d) {
    const auto f = [&](double omega) { return 2 * std::abs(loop.at(omega).T) * std::abs(std::sin(0.5 * omega * d)); };
    const double q = loop.high_frequency_gain();
    double largest = 2 * q / (1 - q);
    double before = 0, here = 0, at = 0, from = 0;  // the last two frequencies and their values
    const auto visit = [&](double omega, double value) {
        if (here >= before && here >= value && from > 0 && here > kMinShareOfMaximum * largest)
            largest = std::max(largest, log_maximum(f, from, {at, here}, omega).value);
        from = at;
        before = here;
        at = omega;
        here = value;
    };
    for (std::size_t i = 0; i < grid.omega.size(); ++i) {
        const double gain = std::abs(grid.point[i].T), omega = grid.omega[i];
        const double last_gain = i > 0 ? std::abs(grid.point[i - 1].T) : 1;
        if (std::max(gain, last_gain) < kMinRelevantShare * largest) continue;
        const double turn = i > 0 ? (omega - grid.omega[i - 1]) * d : 0;
        const int parts = static_cast<int>(std::min<double>(kMaxParts, std::ceil(turn / kMaxTurn)));
        for (int k = 1; k < parts; ++k) {
            const double between = grid.omega[i - 1] + (omega - grid.omega[i - 1]) * k / parts;
            visit(between, f(between));
        }
        visit(omega, 2 * gain * std::abs(std::sin(0.5 * omega * d)));
    }
    return std::max(largest, here);
}

}  // namespace tunewright
