#include "engine/tuning/emulation/search/box_step.h"

#include "engine/numerics/linear_algebra.h"

namespace tunewright::emulation {
namespace {

enum class Side { free, low, high };

double value_of(const std::vector<double>& H, const std::vector<double>& g, const std::vector<double>& d) {
    const std::size_t n = g.size();
    double value = 0;
    for (std::size_t i = 0; i < n; ++i) {
        value += g[i] * d[i];
        for (std::size_t j = 0; j < n; ++j) value += 0.5 * H[i * n + j] * d[i] * d[j];
    }
    return value;
}

// Solves for the free unknowns; the others lie on their side.
std::optional<std::vector<double>> with_sides(const std::vector<double>& H, const std::vector<double>& g,
                                              std::vector<double> d, const std::vector<Side>& sides) {
    const std::size_t n = g.size();
    std::vector<std::size_t> free;
    for (std::size_t i = 0; i < n; ++i)
        if (sides[i] == Side::free) free.push_back(i);
    std::vector<double> matrix, right;
    for (const std::size_t i : free) {
        double b = -g[i];
        for (std::size_t j = 0; j < n; ++j) {
            if (sides[j] == Side::free)
                matrix.push_back(H[i * n + j]);
            else
                b -= H[i * n + j] * d[j];
        }
        right.push_back(b);
    }
    if (free.empty()) return d;
    const auto solved = solve(matrix, right, static_cast<int>(free.size()));
    if (!solved) return std::nullopt;
    for (std::size_t k = 0; k < free.size(); ++k) d[free[k]] = (*solved)[k];
    return d;
}

bool inside(const std::vector<double>& d, const std::vector<double>& low, const std::vector<double>& high) {
    for (std::size_t i = 0; i < d.size(); ++i)
        if (!(d[i] >= low[i] && d[i] <= high[i])) return false;
    return true;
}

}  // namespace

std::vector<double> best_step_in_box(const std::vector<double>& H, const std::vector<double>& g,
                                     const std::vector<double>& low, const std::vector<double>& high) {
    const std::size_t n = g.size();
    std::vector<double> best(n, 0);
    double least = 0;
    std::size_t combinations = 1;
    for (std::size_t i = 0; i < n; ++i) combinations *= 3;
    for (std::size_t code = 0; code < combinations; ++code) {
        std::vector<Side> sides(n);
        std::vector<double> d(n, 0);
        std::size_t rest = code;
        for (std::size_t i = 0; i < n; ++i, rest /= 3) {
            sides[i] = static_cast<Side>(rest % 3);
            if (sides[i] != Side::free) d[i] = sides[i] == Side::low ? low[i] : high[i];
        }
        const auto candidate = with_sides(H, g, d, sides);
        if (!candidate || !inside(*candidate, low, high)) continue;
        const double value = value_of(H, g, *candidate);
        if (value >= least) continue;
        least = value;
        best = *candidate;
        if (code == 0) break;  // nothing holds it
    }
    return best;
}

}  // namespace tunewright::emulation
