#include "engine/check/together/clusters.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>

#include "engine/identification/record/series.h"
#include "engine/number_text.h"

namespace tunewright::check {
namespace {

constexpr double kSamePeriod = 0.04;       // relative
constexpr double kFewestCycles = 10;       // in a record: fewer of two loops agree by chance
constexpr double kSameWave = 0.7;          // of the correlation at the best lag, in each part
constexpr double kSamePhase = 0.1;         // of the period
constexpr std::size_t kParts = 6;          // of the common time
constexpr std::size_t kFewestPoints = 96;  // of the common time
constexpr double kSameSpectrum = 0.85;     // cosine of the powers, for records without a common time
constexpr double kSlave = 0.99;            // correlation of a set point and an output
constexpr std::size_t kPast = 4;           // values of the wave, a half of a period
constexpr double kClearLead = 0.1;         // in ln of the residual's square, as the mean over the others
constexpr std::size_t kMostCompared = 24;  // loops of near periods that one loop is compared with
constexpr double kFewestMoves = 8;         // independent values of a set point or an output: two ramps are alike
constexpr double kSameSpan = 0.01;         // of a record's duration

float at(const Shape& shape, double time) {
    const double place = (time - shape.wave_from) / shape.wave_step;
    if (place < 0 || place > static_cast<double>(shape.wave.size() - 1)) return NAN;
    const auto i = std::min(static_cast<std::size_t>(place), shape.wave.size() - 2);
    const auto part = static_cast<float>(place - static_cast<double>(i));
    return shape.wave[i] + part * (shape.wave[i + 1] - shape.wave[i]);
}

struct TimeSpan {
    double from = 0, to = 0;  ///< s

    double length() const { return to - from; }
    TimeSpan part(int k) const {
        return {from + length() * k / double(kParts), from + length() * (k + 1) / double(kParts)};
    }
};

/// The time that both waves have; from > to: none.
TimeSpan common_time(const Shape& a, const Shape& b) {
    const auto end = [](const Shape& shape) {
        return shape.wave_from + shape.wave_step * static_cast<double>(shape.wave.size() - 1);
    };
    return {std::max(a.wave_from, b.wave_from), std::min(end(a), end(b))};
}

struct Overlap {
    double correlation = 0, lag = 0;  ///< s
    std::size_t points = 0;
};

/// The correlation of b shifted by `lag` with a, over the values of a in a time.
Overlap correlation(const Shape& a, const Shape& b, double lag, const TimeSpan& time) {
    double aa = 0, bb = 0, ab = 0;
    Overlap out{.lag = lag};
    const auto index = [&](double t) {
        return std::size_t(std::clamp(std::ceil((t - a.wave_from) / a.wave_step), 0.0, double(a.wave.size())));
    };
    for (std::size_t i = index(time.from); i < index(time.to); ++i) {
        const float other = at(b, a.wave_from + a.wave_step * static_cast<double>(i) + lag);
        if (std::isnan(other)) continue;
        aa += double(a.wave[i]) * a.wave[i];
        bb += double(other) * other;
        ab += double(a.wave[i]) * other;
        ++out.points;
    }
    if (aa > 0 && bb > 0) out.correlation = ab / std::sqrt(aa * bb);
    return out;
}

Overlap best_lag(const Shape& a, const Shape& b, double period, const TimeSpan& time) {
    Overlap best{.correlation = -1};
    for (double lag = -0.5 * period; lag < 0.5 * period; lag += period / 24) {
        const Overlap here = correlation(a, b, lag, time);
        if (here.points >= kFewestPoints / kParts && here.correlation > best.correlation) best = here;
    }
    return best;
}

/// True if the waves keep one phase in every part of the common time: two loops that only happen to have one period
/// drift against each other.
bool same_wave(const Shape& a, const Shape& b, double period, const TimeSpan& common) {
    std::optional<double> first;
    int known = 0;
    for (int part = 0; part < int(kParts); ++part) {
        const Overlap best = best_lag(a, b, period, common.part(part));
        if (best.points == 0) continue;
        ++known;
        if (best.correlation < kSameWave) return false;
        if (!first) first = best.lag;
        if (std::abs(std::remainder(best.lag - *first, period)) > kSamePhase * period) return false;
    }
    return known >= 3;
}

double cosine(const std::vector<float>& a, const std::vector<float>& b) {
    double aa = 0, bb = 0, ab = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        aa += double(a[i]) * a[i];
        bb += double(b[i]) * b[i];
        ab += double(a[i]) * b[i];
    }
    return aa > 0 && bb > 0 ? ab / std::sqrt(aa * bb) : 0;
}

/// True if the waves have one clock and enough of their time in common.
bool share_time(const Shape& a, const Shape& b) {
    if (!a.dated || !b.dated || a.wave.size() < 2 || b.wave.size() < 2) return false;
    return common_time(a, b).length() >= double(kFewestPoints) * std::max(a.wave_step, b.wave_step);
}

/// Of loops whose periods agree.
bool together(const LoopCheck& a, const LoopCheck& b) {
    if (share_time(a.shape, b.shape))
        return same_wave(a.shape, b.shape, std::sqrt(a.shape.period * b.shape.period), common_time(a.shape, b.shape));
    return cosine(a.shape.spectrum, b.shape.spectrum) > kSameSpectrum;
}

/// The wave of b at the times of a; NaN where b has none.
std::vector<double> on_clock_of(const Shape& a, const Shape& b) {
    std::vector<double> out;
    for (std::size_t i = 0; i < a.wave.size(); ++i)
        out.push_back(double(at(b, a.wave_from + a.wave_step * static_cast<double>(i))));
    return out;
}

/// Least squares of each value on the kPast values before it of the columns; the residual's square.
double residual_square(const std::vector<double>& y, const std::vector<const std::vector<double>*>& columns) {
    const auto width = Eigen::Index(kPast * columns.size());
    Eigen::MatrixXd A = 1e-9 * Eigen::MatrixXd::Identity(width, width);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(width), x(width);
    double squares = 0;
    for (std::size_t i = kPast; i < y.size(); ++i) {
        Eigen::Index k = 0;
        for (const auto* column : columns)
            for (std::size_t lag = 1; lag <= kPast; ++lag) x[k++] = (*column)[i - lag];
        if (!x.allFinite() || !std::isfinite(y[i])) continue;
        A += x * x.transpose();
        b += x * y[i];
        squares += y[i] * y[i];
    }
    return std::max(1e-12, squares - b.dot(A.ldlt().solve(b)));
}

/// ln of the residual's square that the past of `cause` removes from what the past of `effect` itself leaves (Granger
/// 1969, Econometrica 37, 424): large if the cause comes first.
double leads(const Shape& cause, const Shape& effect) {
    const std::vector<double> own(effect.wave.begin(), effect.wave.end()), other = on_clock_of(effect, cause);
    std::vector<double> kept(own);
    for (std::size_t i = 0; i < kept.size(); ++i)
        if (!std::isfinite(other[i])) kept[i] = NAN;
    return std::log(residual_square(kept, {&kept}) / residual_square(kept, {&kept, &other}));
}

bool makes_cycles(const LoopCheck& check) {
    return check.cause.verdict == Verdict::stiction || check.cause.verdict == Verdict::backlash ||
           check.cause.verdict == Verdict::tight;
}

/// How much more a loop leads the others of its group than they lead it, as a mean; empty without a common time.
std::optional<double> lead_over_others(std::span<const LoopCheck* const> loops, const Cluster& cluster,
                                       std::size_t one) {
    double sum = 0;
    int count = 0;
    for (const std::size_t other : cluster.loops) {
        const Shape &a = loops[one]->shape, &b = loops[other]->shape;
        if (other == one || !share_time(a, b)) continue;
        sum += leads(a, b) - leads(b, a);
        ++count;
    }
    return count > 0 ? std::optional(sum / count) : std::nullopt;
}

double strength(const LoopCheck& check) {
    return check.oscillation.periods.empty() ? 0 : check.oscillation.periods.front().share;
}

/// The source is a loop that makes a cycle by itself and whose error moves before those of the others.
void find_source(std::span<const LoopCheck* const> loops, Cluster& cluster) {
    std::ranges::stable_sort(cluster.loops, std::greater<>(), [&](std::size_t i) { return strength(*loops[i]); });
    std::vector<std::pair<double, std::size_t>> makers;
    for (const std::size_t i : cluster.loops) {
        if (!makes_cycles(*loops[i]) || makers.size() == kMostCompared) continue;
        if (const auto lead = lead_over_others(loops, cluster, i)) makers.emplace_back(*lead, i);
    }
    std::ranges::stable_sort(makers, std::greater<>(), &std::pair<double, std::size_t>::first);
    if (!makers.empty()) {
        const auto first = std::ranges::find(cluster.loops, makers.front().second);
        std::rotate(cluster.loops.begin(), first, first + 1);
    }
    const std::string period = figure_text(cluster.period) + " s", tag = loops[cluster.loops[0]]->tag;
    const double second = makers.size() > 1 ? std::max(0.0, makers[1].first) : 0;
    if (makers.empty() || makers.front().first - second <= kClearLead) {
        cluster.why = "No loop stands out as the source of the oscillation with a period of " + period + ": put " +
                      tag + " in manual for some periods and see whether the others stop.";
        return;
    }
    cluster.source = cluster.loops[0];
    cluster.why = "The oscillation with a period of " + period + " is made in " + tag +
                  " itself, and its error moves before those of the others.";
}

/// Loops that oscillate, by period.
std::vector<std::size_t> by_period(std::span<const LoopCheck* const> loops) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < loops.size(); ++i) {
        const Shape& shape = loops[i]->shape;
        if (shape.period > 0 && shape.wave.size() >= 2 && shape.to - shape.from >= kFewestCycles * shape.period)
            order.push_back(i);
    }
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return loops[i]->shape.period; });
    return order;
}

bool moves_often(const std::vector<float>& values) {
    return values.size() > std::size_t(kFewestMoves) &&
           effective_samples(std::vector<double>(values.begin(), values.end())) >= kFewestMoves;
}

}  // namespace

std::vector<Cluster> clusters_of(std::span<const LoopCheck* const> loops) {
    std::vector<std::size_t> group(loops.size());
    std::iota(group.begin(), group.end(), 0);
    const auto root = [&](std::size_t i) {
        while (group[i] != i) i = group[i] = group[group[i]];
        return i;
    };
    const auto order = by_period(loops);
    for (std::size_t i = 0; i < order.size(); ++i) {
        const LoopCheck& one = *loops[order[i]];
        std::size_t compared = 0;
        for (std::size_t k = i + 1; k < order.size() && compared < kMostCompared; ++k) {
            const LoopCheck& other = *loops[order[k]];
            if (std::log(other.shape.period / one.shape.period) > kSamePeriod) break;
            if (root(order[i]) == root(order[k])) continue;
            ++compared;
            if (together(one, other)) group[root(order[k])] = root(order[i]);
        }
    }
    std::vector<Cluster> all(loops.size());
    for (const std::size_t i : order) all[root(i)].loops.push_back(i);
    std::erase_if(all, [&](const Cluster& cluster) {
        const bool all_healthy = std::ranges::all_of(
            cluster.loops, [&](std::size_t i) { return loops[i]->cause.verdict == Verdict::healthy; });
        return cluster.loops.size() < 2 || all_healthy;
    });
    for (Cluster& cluster : all) {
        double sum = 0;
        for (const std::size_t i : cluster.loops) sum += std::log(loops[i]->shape.period);
        cluster.period = std::exp(sum / static_cast<double>(cluster.loops.size()));
        find_source(loops, cluster);
    }
    std::ranges::stable_sort(all, std::greater<>(), [](const Cluster& cluster) { return cluster.loops.size(); });
    return all;
}

std::vector<CascadePair> cascades_of(std::span<const LoopCheck* const> loops) {
    std::vector<std::size_t> slaves, masters;
    for (std::size_t i = 0; i < loops.size(); ++i) {
        if (moves_often(loops[i]->shape.set_point)) slaves.push_back(i);
        if (moves_often(loops[i]->shape.output)) masters.push_back(i);
    }
    std::vector<CascadePair> pairs;
    for (const std::size_t master : masters) {
        for (const std::size_t slave : slaves) {
            const Shape &outer = loops[master]->shape, &inner = loops[slave]->shape;
            const double apart = std::max(std::abs(outer.from - inner.from), std::abs(outer.to - inner.to));
            if (master == slave || !outer.dated || !inner.dated || apart > kSameSpan * (outer.to - outer.from))
                continue;
            if (cosine(outer.output, inner.set_point) > kSlave) pairs.push_back({master, slave});
        }
    }
    return pairs;
}

}  // namespace tunewright::check
