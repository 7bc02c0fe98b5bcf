#include "engine/loop/dead_time_tolerance.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "engine/numerics/log_maximum.h"
#include "engine/numerics/sign_change.h"

namespace tunewright {
namespace {

constexpr double kMaxTurn = 0.25;         // rad of d between two frequencies that are looked at
constexpr double kNoGain = 0.5;           // below it no turn of the dead time can bring |T| |e^(-jwd) - 1| to 1
constexpr double kEdgeTolerance = 1e-13;  // relative, of the frequency at which |T| passes 1/2

/// 1/d at one frequency: 0 where |T| is too small to matter.
double inverse_tolerance(double omega, double gain) { return gain < kNoGain ? 0 : omega / (2 * std::asin(0.5 / gain)); }

/// The frequency at which |T| passes 1/2 between neighbouring points i and k of the grid.
double band_edge(const Loop& loop, const LoopGrid& grid, std::size_t i, std::size_t k) {
    const auto gain = [&](std::size_t at) { return std::abs(grid.point[at].T) - kNoGain; };
    return log_root([&](double omega) { return std::abs(loop.at(omega).T) - kNoGain; }, grid.omega[i], grid.omega[k],
                    gain(i), gain(k), kEdgeTolerance);
}

}  // namespace

double small_gain_dead_time(const Loop& loop, const LoopGrid& grid) {
    const double q = loop.high_frequency_gain();
    if (q >= kNoGain * (1 - q)) return 0;
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
        if (here >= before && here >= value && from > 0 && here > 0.9 * largest)
            largest = std::max(largest, log_maximum(f, from, {at, here}, omega).value);
        from = at;
        before = here;
        at = omega;
        here = value;
    };
    for (std::size_t i = 0; i < grid.omega.size(); ++i) {
        const double gain = std::abs(grid.point[i].T), omega = grid.omega[i];
        const double last_gain = i > 0 ? std::abs(grid.point[i - 1].T) : 1;
        if (std::max(gain, last_gain) < 0.45 * largest) continue;  // 2 |T| cannot come near what was found
        const double turn = i > 0 ? (omega - grid.omega[i - 1]) * d : 0;
        const int parts = static_cast<int>(std::min(200.0, std::ceil(turn / kMaxTurn)));
        for (int k = 1; k < parts; ++k) {
            const double between = grid.omega[i - 1] + (omega - grid.omega[i - 1]) * k / parts;
            visit(between, f(between));
        }
        visit(omega, 2 * gain * std::abs(std::sin(0.5 * omega * d)));
    }
    return std::max(largest, here);
}

}  // namespace tunewright
