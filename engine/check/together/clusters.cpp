#include "engine/check/together/clusters.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>

#include "engine/number_text.h"

namespace tunewright::check {
namespace {

constexpr double kSamePeriod = 0.04;       // relative
constexpr double kSameWave = 0.7;          // of the correlation at the best lag, in each part
constexpr double kSamePhase = 0.1;         // of the period
constexpr std::size_t kParts = 6;          // of the common time
constexpr std::size_t kFewestPoints = 96;  // of the common time
constexpr double kSameSpectrum = 0.85;     // cosine of the powers, for records without a common time
constexpr double kSlave = 0.99;            // correlation of a set point and an output
constexpr std::size_t kPast = 4;           // values of the wave, a half of a period
constexpr double kClearLead = 0.1;         // in ln of the residual's square, over all others
constexpr double kNoMaker = 0.5;           // the same: a loop without a cause of its own is not the source

float at(const Shape& shape, double time) {
    const double place = (time - shape.wave_from) / shape.wave_step;
    if (place < 0 || place > static_cast<double>(shape.wave.size() - 1)) return NAN;
    const auto i = std::min(static_cast<std::size_t>(place), shape.wave.size() - 2);
    const auto part = static_cast<float>(place - static_cast<double>(i));
    return shape.wave[i] + part * (shape.wave[i + 1] - shape.wave[i]);
}

struct Overlap {
    double correlation = 0, lag = 0;  ///< s
    std::size_t points = 0;
};

/// The correlation of b shifted by `lag` with a, over the part `part` of the time that both have.
Overlap correlation(const Shape& a, const Shape& b, double lag, int part) {
    double aa = 0, bb = 0, ab = 0;
    Overlap out{.lag = lag};
    const std::size_t from = a.wave.size() * std::size_t(part) / kParts,
                      to = a.wave.size() * std::size_t(part + 1) / kParts;
    for (std::size_t i = from; i < to; ++i) {
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

Overlap best_lag(const Shape& a, const Shape& b, double period, int part) {
    Overlap best;
    for (double lag = -0.5 * period; lag < 0.5 * period; lag += period / 24) {
        const Overlap here = correlation(a, b, lag, part);
        if (here.points >= kFewestPoints / kParts && here.correlation > best.correlation) best = here;
    }
    return best;
}

/// True if the waves keep one phase in every part of the common time: two loops that only happen to have one period
/// drift against each other.
bool same_wave(const Shape& a, const Shape& b, double period) {
    std::optional<double> first;
    int known = 0;
    for (int part = 0; part < int(kParts); ++part) {
        const Overlap best = best_lag(a, b, period, part);
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

bool share_time(const Shape& a, const Shape& b) {
    return a.dated == b.dated && std::min(a.to, b.to) > std::max(a.from, b.from);
}

bool together(const LoopCheck& a, const LoopCheck& b) {
    const double Ta = a.shape.period, Tb = b.shape.period;
    if (!(Ta > 0 && Tb > 0) || std::abs(std::log(Ta / Tb)) > kSamePeriod) return false;
    if (a.shape.wave.size() < 2 || b.shape.wave.size() < 2) return false;
    if (share_time(a.shape, b.shape)) return same_wave(a.shape, b.shape, std::sqrt(Ta * Tb));
    return cosine(a.shape.spectrum, b.shape.spectrum) > kSameSpectrum;
}

/// The wave of b at the places of a, `lag` later; empty where b has none.
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

/// How much more each loop leads the others than they lead it; without a common time the share of the oscillation.
std::vector<double> source_scores(std::span<const LoopCheck* const> loops, const Cluster& cluster) {
    std::vector<double> scores(cluster.loops.size(), 0.0);
    for (std::size_t i = 0; i < scores.size(); ++i) {
        const LoopCheck& one = *loops[cluster.loops[i]];
        for (std::size_t k = 0; k < scores.size(); ++k) {
            const LoopCheck& other = *loops[cluster.loops[k]];
            if (i == k || !share_time(one.shape, other.shape)) continue;
            const double lead = leads(one.shape, other.shape);
            scores[i] += lead;
            scores[k] -= lead;
        }
        scores[i] += makes_cycles(one) ? 0 : -kNoMaker;
    }
    return scores;
}

void find_source(std::span<const LoopCheck* const> loops, Cluster& cluster) {
    const auto scores = source_scores(loops, cluster);
    std::vector<std::size_t> order(scores.size());
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) { return scores[i]; });
    std::vector<std::size_t> sorted;
    for (const std::size_t i : order) sorted.push_back(cluster.loops[i]);
    cluster.loops = std::move(sorted);
    const LoopCheck& first = *loops[cluster.loops[0]];
    const std::string period = figure_text(cluster.period) + " s";
    const bool clear = scores[order[0]] - scores[order[1]] > kClearLead;
    if (!clear || !makes_cycles(first)) {
        cluster.why = "No loop stands out as the source of the oscillation with a period of " + period + ": put " +
                      first.tag + " in manual for some periods and see whether the others stop.";
        return;
    }
    cluster.source = cluster.loops[0];
    cluster.why = "The oscillation with a period of " + period + " is made in " + first.tag +
                  " itself, and its error moves before those of the others.";
}

}  // namespace

std::vector<Cluster> clusters_of(std::span<const LoopCheck* const> loops) {
    std::vector<std::size_t> group(loops.size());
    std::iota(group.begin(), group.end(), 0);
    const auto root = [&](std::size_t i) {
        while (group[i] != i) i = group[i] = group[group[i]];
        return i;
    };
    for (std::size_t i = 0; i < loops.size(); ++i)
        for (std::size_t k = i + 1; k < loops.size(); ++k)
            if (root(i) != root(k) && together(*loops[i], *loops[k])) group[root(k)] = root(i);
    std::vector<Cluster> all(loops.size());
    for (std::size_t i = 0; i < loops.size(); ++i) all[root(i)].loops.push_back(i);
    std::erase_if(all, [](const Cluster& cluster) { return cluster.loops.size() < 2; });
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
    std::vector<CascadePair> pairs;
    for (std::size_t master = 0; master < loops.size(); ++master) {
        for (std::size_t slave = 0; slave < loops.size(); ++slave) {
            const Shape &outer = loops[master]->shape, &inner = loops[slave]->shape;
            if (master == slave || outer.output.empty() || inner.set_point.empty()) continue;
            if (!share_time(outer, inner) || std::abs(outer.from - inner.from) > 0.01 * (outer.to - outer.from))
                continue;
            if (cosine(outer.output, inner.set_point) > kSlave) pairs.push_back({master, slave});
        }
    }
    return pairs;
}

}  // namespace tunewright::check
