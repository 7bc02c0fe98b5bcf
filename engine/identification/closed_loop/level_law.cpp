#include "engine/identification/closed_loop/level_law.h"

#include <cmath>
#include <span>

#include "engine/identification/record/series.h"
#include "engine/numerics/statistics.h"

namespace tunewright {
namespace {

int turns_of(std::span<const double> u) {
    int turns = 0;
    double last = 0;
    for (std::size_t i = 1; i < u.size(); ++i) {
        const double move = u[i] - u[i - 1];
        if (move == 0) continue;
        turns += move * last < 0 ? 1 : 0;
        last = move;
    }
    return turns;
}

/// Root mean square of the residual of u from the line over y.
double left_of(std::span<const double> u, std::span<const double> y, const Line& line) {
    double squares = 0;
    for (const double left : residuals(line, y, u)) squares += left * left;
    return std::sqrt(squares / static_cast<double>(u.size()));
}

}  // namespace

std::optional<LevelLaw> level_law(const CleanRecord& record, const std::vector<double>& u) {
    constexpr int kMinTurns = 12;
    constexpr double kMaxRoundingDeviations = 1.5;    // of the rounding's standard deviation
    constexpr double kMaxUnexplainedDeviation = 0.3;  // of u's standard deviation: a line with a larger residual is no
                                                      // law
    if (turns_of(u) < kMinTurns) return std::nullopt;
    const double of_u = quantisation_step(u), of_y = quantisation_step(record.y);
    if (!(of_u > 0) || !(of_y > 0)) return std::nullopt;
    const std::span v(u), y(record.y);
    const Line line = straight_line(y, v);
    const double left = left_of(v, y, line), rounding = std::hypot(of_u, line.slope * of_y) / std::sqrt(12.0);
    if (left > kMaxRoundingDeviations * rounding || left > kMaxUnexplainedDeviation * deviation(u)) return std::nullopt;
    const auto before = v.first(v.size() - 1), after = y.last(y.size() - 1);
    if (left_of(before, after, straight_line(after, before)) < left) return std::nullopt;
    return LevelLaw{line.slope, left};
}

}  // namespace tunewright
