#include "engine/loop/margins.h"

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "engine/numerics/fast_complex.h"
#include "engine/numerics/sign_change.h"

namespace tunewright {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPi = std::numbers::pi;
constexpr double kToRounding = 1e-13;  // of ln omega

/// L (real and negative) at some frequency: the factor 1/|L| brings it to -1.
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

void note_unit_crossing(Margins& margins, std::complex<double> L, double omega) {
    double lag = std::arg(L) + kPi;  // from -1 counter-clockwise to L: what a further lag uses up, in [0, 2 pi)
    if (lag >= 2 * kPi) lag -= 2 * kPi;
    const double distance = std::min(lag, 2 * kPi - lag);
    if (distance < margins.phase_margin) {
        margins.phase_margin = distance;
        margins.gain_crossover = omega;
    }
    margins.delay_margin = std::min(margins.delay_margin, lag / omega);
}

/// The two ends of the axis, where L is real or its magnitude tends to a limit.
void note_limits(Margins& margins, const Loop& loop) {
    const auto [numerator, denominator] = loop.fraction(0);
    if (denominator != 0.0) note_real_crossing(margins, (numerator / denominator).real(), 0);
    const double q = loop.signed_high_frequency_gain();
    if (q == 0) return;
    if (loop.plant().dead_time() > 0) {
        note_real_crossing(margins, -std::abs(q), kInfinity);  // every direction is reached again and again
    } else {
        note_real_crossing(margins, q, kInfinity);
        if (std::abs(q) > 1) margins.delay_margin = 0;
    }
}

}  // namespace

Margins find_interior_margins(const std::function<std::complex<double>(double)>& open_loop, const LoopGrid& grid) {
    Margins margins{kInfinity, 0, kInfinity, kInfinity, 0, 0};
    const auto imaginary = [&](double omega) {
        const auto L = open_loop(omega);
        return L.imag() / magnitude(L);
    };
    const auto log_gain = [&](double omega) { return std::log(magnitude(open_loop(omega))); };
    for (std::size_t i = 1; i < grid.omega.size(); ++i) {
        const auto a = grid.point[i - 1].L, b = grid.point[i].L;
        const double left = grid.omega[i - 1], right = grid.omega[i];
        const bool resolved = right <= grid.resolved_to;
        if (!std::isfinite(magnitude(a)) || !std::isfinite(magnitude(b))) continue;
        if (resolved && (a.imag() < 0) != (b.imag() < 0) && (a.real() < 0 || b.real() < 0)) {
            const double omega =
                log_root(imaginary, left, right, a.imag() / magnitude(a), b.imag() / magnitude(b), kToRounding);
            note_real_crossing(margins, open_loop(omega).real(), omega);
        }
        if (!resolved && 1 / magnitude(b) > 1) note_real_crossing(margins, -magnitude(b), right);
        if ((magnitude(a) < 1) != (magnitude(b) < 1)) {
            const double omega =
                log_root(log_gain, left, right, std::log(magnitude(a)), std::log(magnitude(b)), kToRounding);
            note_unit_crossing(margins, open_loop(omega), omega);
        }
    }
    return margins;
}

Margins find_margins(const Loop& loop, const LoopGrid& grid) {
    Margins margins = find_interior_margins([&](double omega) { return loop.open_loop({0, omega}); }, grid);
    note_limits(margins, loop);
    return margins;
}

}  // namespace tunewright
