#include "engine/simulation/replay/replay_figures.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tunewright {
namespace {

// Turning points of u, a move back counting from `band` on.
int reversals_of(std::span<const double> u, double band) {
    if (u.empty()) return 0;
    int count = 0, direction = 0;
    double low = u.front(), high = u.front();  // since the last turn
    for (const double value : u) {
        low = std::min(low, value);
        high = std::max(high, value);
        const bool up = value - low > band, down = high - value > band;
        const int now = direction > 0 ? (down ? -1 : 1) : direction < 0 ? (up ? 1 : -1) : up ? 1 : down ? -1 : 0;
        if (now == direction) {
            continue;
        }
        if (direction != 0) ++count;
        direction = now;
        low = high = value;
    }
    return count;
}

}  // namespace

ReplayFigures replay_figures(double h, std::span<const double> r, std::span<const double> y, std::span<const double> u,
                             double band) {
    ReplayFigures figures;
    for (std::size_t k = 0; k < y.size(); ++k) {
        const double error = std::abs(r[k] - y[k]);
        figures.IAE += error * h;
        figures.largest_error = std::max(figures.largest_error, error);
        if (k > 0) figures.travel += std::abs(u[k] - u[k - 1]);
    }
    figures.reversals = reversals_of(u, band);
    return figures;
}

}  // namespace tunewright
