#include "engine/check/clusters.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "engine/number_text.h"

namespace tunewright::check {
namespace {

constexpr double kSamePeriod = 0.05;       // relative
constexpr double kSameWave = 0.6;          // of the correlation at the best lag
constexpr std::size_t kFewestPoints = 96;  // of the common time
constexpr double kSameSpectrum = 0.85;     // cosine of the powers, for records without a common time
constexpr double kSlave = 0.99;            // correlation of a set point and an output
constexpr double kClearSource = 1.3;       // ratio of the oscillation's shares that makes a source stand out

float at(const Shape& shape, double time) {
    const double place = (time - shape.wave_from) / shape.wave_step;
    if (place < 0 || place > static_cast<double>(shape.wave.size() - 1)) return NAN;
    const auto i = std::min(static_cast<std::size_t>(place), shape.wave.size() - 2);
    const auto part = static_cast<float>(place - static_cast<double>(i));
    return shape.wave[i] + part * (shape.wave[i + 1] - shape.wave[i]);
}

struct Overlap {
    double correlation = 0;
    std::size_t points = 0;
};

/// The correlation of b shifted by `lag` with a, over the time that both have.
Overlap correlation(const Shape& a, const Shape& b, double lag) {
    double aa = 0, bb = 0, ab = 0;
    Overlap out;
    for (std::size_t i = 0; i < a.wave.size(); ++i) {
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

bool same_wave(const Shape& a, const Shape& b, double period) {
    double best = 0;
    std::size_t points = 0;
    for (double lag = -0.5 * period; lag <= 0.5 * period; lag += period / 24) {
        const Overlap here = correlation(a, b, lag);
        points = std::max(points, here.points);
        best = std::max(best, std::abs(here.correlation));
    }
    return points >= kFewestPoints && best > kSameWave;
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

/// How likely the oscillation begins here: a valve or a loop that makes it, the most distorted wave, the largest share.
double source_score(const LoopCheck& check) {
    double score = check.oscillation.periods.front().share * (1 + std::max(0.0F, check.shape.nonlinearity));
    switch (check.cause.verdict) {
        case Verdict::stiction:
        case Verdict::backlash: return 4 * score;
        case Verdict::tight: return 3 * score;
        case Verdict::external: return 0.5 * score;
        default: return score;
    }
}

void find_source(std::span<const LoopCheck* const> loops, Cluster& cluster) {
    std::ranges::stable_sort(cluster.loops, std::greater<>(), [&](std::size_t i) { return source_score(*loops[i]); });
    const LoopCheck &first = *loops[cluster.loops[0]], &second = *loops[cluster.loops[1]];
    const std::string period = figure_text(cluster.period) + " s";
    if (source_score(first) < kClearSource * source_score(second)) {
        cluster.why = "No loop stands out as the source of the oscillation with a period of " + period + ": put " +
                      first.tag + " in manual for some periods and see whether the others stop.";
        return;
    }
    cluster.source = cluster.loops[0];
    const bool own = first.cause.verdict == Verdict::stiction || first.cause.verdict == Verdict::backlash ||
                     first.cause.verdict == Verdict::tight;
    cluster.why = own ? "The oscillation with a period of " + period + " is made in " + first.tag + " itself."
                      : "The oscillation with a period of " + period + " is strongest in " + first.tag + ".";
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
