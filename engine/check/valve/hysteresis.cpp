#include "engine/check/valve/hysteresis.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/check/samples.h"

namespace tunewright::check {
namespace {

using Vector = Eigen::VectorXd;

constexpr std::size_t kBlocks = 400;
constexpr double kBlocksPerPeriod = 12;
// Lags of the plant and dead times, in blocks. The plant without a valve may be slower, or of two lags: what a valve is
// compared with must be the better linear one.
constexpr double kLags[] = {0, 1, 2, 4, 8, 16};
constexpr double kLongLags[] = {32, 64, 128};
constexpr double kDoubleLags[] = {2, 6, 16, 40};
constexpr int kDeadTimes[] = {0, 1, 2, 3, 4, 6, 9};

Vector vector(const std::vector<double>& values) {
    return Eigen::Map<const Vector>(values.data(), Eigen::Index(values.size()));
}

Vector lagged(const Vector& x, double lag) {
    if (lag == 0 || x.size() == 0) return x;
    const double a = std::exp(-1 / lag);
    Vector out(x.size());
    double state = 0;
    for (Eigen::Index i = 0; i < x.size(); ++i) out[i] = state = a * state + (1 - a) * (x[i] - x[0]);
    return out;
}

Vector integrated(const Vector& x) {
    Vector out(x.size());
    const double centre = x.mean();
    double sum = 0;
    for (Eigen::Index i = 0; i < x.size(); ++i) out[i] = sum += x[i] - centre;
    return out;
}

struct Best {
    double square = std::numeric_limits<double>::infinity();  ///< mean of the residual's squares
    double gain = 0;
    std::size_t valve = 0;
};

/// Least squares of gain and offset, and of a ramp for an integral, over the dead times.
void try_input(const Vector& x, const Vector& y, bool ramp, std::size_t valve, Best& best) {
    for (const int dead : kDeadTimes) {
        const Eigen::Index n = y.size() - dead;
        if (n < Eigen::Index(kBlocks / 4)) break;
        Vector in = x.head(n), out = y.tail(n);
        in.array() -= in.mean();
        out.array() -= out.mean();
        if (ramp) {
            const Vector line = Vector::LinSpaced(n, -1, 1).normalized();
            in -= line * line.dot(in);
            out -= line * line.dot(out);
        }
        const double squares = in.squaredNorm();
        const double gain = in.dot(out) / std::max(squares, 1e-12);
        const double left = (out.squaredNorm() - gain * in.dot(out)) / double(n);
        if (left < best.square) best = {left, gain, valve};
    }
}

Best without_valve(const Vector& u, const Vector& y) {
    Best best;
    for (const double lag : kLags) try_input(lagged(u, lag), y, false, 0, best);
    for (const double lag : kLongLags) try_input(lagged(u, lag), y, false, 0, best);
    for (const double first : kDoubleLags)
        for (const double second : kDoubleLags)
            if (second >= first) try_input(lagged(lagged(u, first), second), y, false, 0, best);
    try_input(integrated(u), y, true, 0, best);
    return best;
}

int turns(std::span<const double> output, double least) {
    int count = 0, direction = 0;
    double low = output.front(), high = low;
    for (const double u : output) {
        low = std::min(low, u);
        high = std::max(high, u);
        if (direction >= 0 && u < high - least) {
            ++count;
            direction = -1;
            low = high = u;
        } else if (direction <= 0 && u > low + least) {
            ++count;
            direction = 1;
            low = high = u;
        }
    }
    return count;
}

}  // namespace

std::optional<HysteresisFit> fit_hysteresis(std::span<const double> measurement, std::span<const double> set_point,
                                            const ValveBank& bank, double period) {
    if (bank.valves().empty()) return std::nullopt;
    const auto thinned = bank.thinned(measurement);
    const std::size_t n = std::min(thinned.size(), bank.output().size());
    const auto block = static_cast<std::size_t>(
        std::max(1.0, std::min(std::floor(double(n) / kBlocks), period / double(bank.stride()) / kBlocksPerPeriod)));
    const std::size_t used = std::min(n, 2 * kBlocks * block);
    const auto part = [&](const std::vector<double>& values) {
        return vector(block_means(std::span(values).last(used), block));
    };
    const Vector y = part(thinned), u = part(bank.output());
    if (y.size() < Eigen::Index(kBlocks / 2)) return std::nullopt;
    const double variance = (y.array() - y.mean()).square().mean() + 1e-300;
    Best linear = without_valve(u, y);
    if (!set_point.empty()) {
        const Best by_set_point = without_valve(part(bank.thinned(set_point)), y);
        linear.square = std::min(linear.square, by_set_point.square);
    }
    Best best;
    for (std::size_t k = 0; k < bank.valves().size(); ++k) {
        const Vector v = part(bank.position(k));
        for (const double lag : kLags) try_input(lagged(v, lag), y, false, k, best);
    }
    const ValveModel& valve = bank.valves()[best.valve];
    const auto rows = std::span(bank.output()).last(used);
    const auto [low, high] = std::ranges::minmax(rows);
    HysteresisFit fit;
    const double floor = 1e-12 * variance;
    fit.gain = std::log((std::max(0.0, linear.square) + floor) / (std::max(0.0, best.square) + floor));
    fit.explained = 1 - best.square / variance;
    fit.explained_without = 1 - linear.square / variance;
    fit.band = valve.band;
    fit.jump = valve.jump;
    fit.plant_gain = best.gain;
    fit.ratio = valve.band / (high - low + 1e-12);
    fit.turns = turns(rows, 0.5 * valve.band);
    return fit;
}

}  // namespace tunewright::check
