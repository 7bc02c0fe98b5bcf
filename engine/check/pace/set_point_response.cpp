#include "engine/check/pace/set_point_response.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/identification/record/series.h"
#include "engine/numerics/statistics.h"

namespace tunewright::check {
namespace {

constexpr double kLeastMove = 4;         // standard deviations of the noise
constexpr std::size_t kBefore = 10;      // rows at rest before a move
constexpr std::size_t kLeastAfter = 30;  // rows
constexpr double kBegun = 0.05, kRisen = 0.632;

struct Move {
    std::size_t at = 0;
    double size = 0;
    std::size_t after = 0;  ///< rows until the next move
};

std::vector<Move> moves_of(const std::vector<double>& r, double least) {
    std::vector<Move> moves;
    for (std::size_t i = 1; i < r.size(); ++i) {
        if (r[i] == r[i - 1]) continue;
        if (!moves.empty()) moves.back().after = i - moves.back().at;
        moves.push_back({i, r[i] - r[i - 1], r.size() - i});
    }
    std::size_t before = 0;
    std::vector<Move> alone;
    for (const Move& move : moves) {
        if (std::abs(move.size) > least && move.after >= kLeastAfter && move.at >= before + kBefore)
            alone.push_back(move);
        before = move.at;
    }
    return alone;
}

/// The first row from `from` on at which the response reaches the level and stays above it for some rows.
std::optional<double> reached(const std::vector<double>& response, double level, std::size_t from) {
    for (std::size_t i = std::max<std::size_t>(from, 1); i + 2 < response.size(); ++i) {
        if (response[i] < level || response[i + 1] < level || response[i + 2] < level) continue;
        const double before = response[i - 1];
        const double part = before < level && response[i] > before ? (level - before) / (response[i] - before) : 1;
        return double(i - 1) + part;
    }
    return std::nullopt;
}

}  // namespace

std::optional<SetPointResponse> set_point_response(const Samples& samples) {
    if (samples.r.empty()) return std::nullopt;
    const double noise = noise_std(samples.y);
    const auto moves = moves_of(samples.r, kLeastMove * noise);
    if (moves.empty()) return std::nullopt;
    std::size_t rows = 0;
    for (const Move& move : moves) rows = std::max(rows, move.after);
    std::vector<double> sum(rows, 0.0), weight(rows, 0.0);
    for (const Move& move : moves) {
        const double rest = mean(std::span(samples.y).subspan(move.at - kBefore, kBefore));
        for (std::size_t i = 0; i < move.after; ++i) {
            sum[i] += (samples.y[move.at + i] - rest) * move.size;
            weight[i] += move.size * move.size;
        }
    }
    for (std::size_t i = 0; i < rows; ++i) sum[i] /= weight[i];
    SetPointResponse out;
    out.moves = int(moves.size());
    out.noise = noise / std::sqrt(weight.front());
    const auto begun = reached(sum, std::max(kBegun, 3 * out.noise), 0);
    if (!begun) return std::nullopt;
    const auto risen = reached(sum, kRisen, std::size_t(*begun));
    if (!risen) return std::nullopt;
    out.dead_time = *begun * samples.step;
    out.rise = (*risen - *begun) * samples.step;
    return out;
}

}  // namespace tunewright::check
