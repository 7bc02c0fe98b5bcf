#include "engine/check/together/plant_check.h"

#include <algorithm>
#include <boost/math/distributions/fisher_f.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "engine/check/action.h"
#include "engine/check/together/clusters.h"

namespace tunewright::check {
namespace {

constexpr const char* kMovesWithSource = "moves-with-source";
constexpr double kSluggishGain = 0.5;  // of the mean error: what tuning a sluggish loop is known to save, about
constexpr double kValveGain = 0.8;     // of the oscillation's share, which ends with its cause

/// The oscillation's share of the error's mean square, a lasting offset included.
double oscillating_share(const LoopCheck& check) {
    if (!check.oscillation.found) return 0;
    const double variance = check.performance.variability * check.performance.variability;
    const double square = variance + check.performance.offset * check.performance.offset;
    return square > 0 ? check.oscillation.periods.front().share * variance / square : 0;
}

/// The share of the error that mending may remove.
Figure share_of(const LoopCheck& check) {
    const double oscillating = oscillating_share(check);
    switch (check.cause.verdict) {
        case Verdict::healthy: return 0.0;
        case Verdict::stiction:
        case Verdict::backlash:
        case Verdict::tight: return kValveGain * (1 - std::sqrt(std::max(0.0, 1 - oscillating)));
        case Verdict::sluggish: return kSluggishGain;
        case Verdict::external:
            return no_figure("The disturbance comes from outside: what this loop gains is known once its source is.");
        case Verdict::saturation:
        case Verdict::manual:
        case Verdict::frozen:
        case Verdict::quantised: return no_figure("The gain cannot be estimated from this record.");
        default: return no_figure("The cause is open.");
    }
}

int effort_of(ActionCode code) {
    switch (code) {
        case ActionCode::none: return 0;
        case ActionCode::retune:
        case ActionCode::return_to_automatic: return 1;
        case ActionCode::test:
        case ActionCode::record_again: return 2;
        default: return 3;
    }
}

Rank rank_of(std::size_t index, const LoopCheck& check) {
    Rank rank;
    rank.loop = index;
    rank.share = share_of(check);
    rank.effort = effort_of(check.action.code);
    if (!rank.share) {
        rank.gain = rank.money = no_figure(rank.share.why);
        return rank;
    }
    rank.gain = *rank.share * check.performance.mean_error;
    rank.money = check.weight ? Figure(*check.weight * *rank.gain) : no_figure("The loop has no weight.");
    return rank;
}

/// What a loop is first ordered by: sources of others, then other loops with a cause, disturbed, open and healthy ones.
int urgency(const LoopCheck& check, bool source) {
    switch (check.action.code) {
        case ActionCode::none: return 0;
        case ActionCode::record_again:
        case ActionCode::test: return 1;
        case ActionCode::find_source: return 2;
        default: return source ? 4 : 3;
    }
}

/// True for a verdict that the oscillation of another loop may have caused.
bool may_be_explained(Verdict verdict) {
    return verdict == Verdict::stiction || verdict == Verdict::backlash || verdict == Verdict::tight ||
           verdict == Verdict::external || verdict == Verdict::undetermined || verdict == Verdict::healthy;
}

void explain_by_source(LoopCheck& check, const LoopCheck& source) {
    Cause& cause = check.cause;
    if (!may_be_explained(cause.verdict)) return;
    cause.alternatives.clear();
    if (cause.verdict == Verdict::stiction || cause.verdict == Verdict::backlash || cause.verdict == Verdict::tight)
        cause.alternatives = {cause.verdict};
    cause.verdict = Verdict::external;
    cause.confidence = Confidence::likely;
    cause.size = cause.jump = no_figure("Another loop makes the oscillation.");
    cause.why_open.clear();
    // What spoke for a cause of its own is overruled.
    std::erase_if(cause.evidence, [](const Evidence& one) { return one.code != "regularity"; });
    cause.evidence.insert(cause.evidence.begin(),
                          {kMovesWithSource,
                           check.oscillation.periods.empty() ? 0 : check.oscillation.periods.front().period,
                           {},
                           "The loop oscillates together with " + source.tag + ", where the oscillation is made."});
    check.action = action_for(check, source.tag);
}

}  // namespace

PlantCheck check_plant(std::span<LoopCheck* const> loops, bool cluster) {
    PlantCheck plant;
    const std::vector<const LoopCheck*> seen(loops.begin(), loops.end());
    plant.cascades = cascades_of(seen);
    if (cluster) plant.clusters = clusters_of(seen);
    for (const Cluster& found : plant.clusters)
        for (const std::size_t i : found.loops)
            if (found.source && i != *found.source) explain_by_source(*loops[i], *loops[*found.source]);
    std::vector<bool> source(loops.size(), false);
    for (std::size_t i = 0; i < loops.size(); ++i) plant.ranking.push_back(rank_of(i, *loops[i]));
    for (const Cluster& found : plant.clusters) {
        if (!found.source) continue;
        source[*found.source] = true;
        for (const std::size_t i : found.loops)
            if (i != *found.source) plant.ranking[i].after = *found.source;
    }
    const auto before = [&](const Rank& a, const Rank& b) {
        const LoopCheck &first = *loops[a.loop], &second = *loops[b.loop];
        const int ua = urgency(first, source[a.loop]), ub = urgency(second, source[b.loop]);
        if (ua != ub) return ua > ub;
        if (a.money.has_value() != b.money.has_value()) return a.money.has_value();
        if (a.money && *a.money != *b.money) return *a.money > *b.money;
        return a.share.value_or(0) > b.share.value_or(0);
    };
    std::ranges::stable_sort(plant.ranking, before);
    return plant;
}

Change change_of(const LoopCheck& before, const LoopCheck& now) {
    Change change{.before = before.cause.verdict, .now = now.cause.verdict};
    const PerformanceFigures &old = before.performance, &young = now.performance;
    if (!(old.variability > 0 && young.variability > 0)) {
        change.variability_ratio = change.likelihood = no_figure("One of the two records has no error that varies.");
        return change;
    }
    const double ratio = young.variability / old.variability;
    change.variability_ratio = ratio;
    if (!(old.independent > 2 && young.independent > 2)) {
        change.likelihood = no_figure("The records have too few independent values.");
        return change;
    }
    const boost::math::fisher_f_distribution<double> chance(young.independent - 1, old.independent - 1);
    const double below = boost::math::cdf(chance, std::min(ratio * ratio, std::numeric_limits<double>::max()));
    change.likelihood = std::min(1.0, 2 * std::min(below, 1 - below));
    change.significant = *change.likelihood < kByChance;
    return change;
}

}  // namespace tunewright::check
