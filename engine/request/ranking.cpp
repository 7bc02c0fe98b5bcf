#include "engine/request/ranking.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "engine/number_text.h"

namespace tunewright {
namespace {

constexpr double kOwnTolerance = 1.01;     // of the limit that a method was asked for: what a warning overlooks too
constexpr double kRankTolerance = 1.0001;  // of the limit on all: designs at a limit lie there to about 1e-5

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Of the loop as it will run: on the worst plant that it must serve, and in the user's own controller.
Figure judged_Ms(const TuningEntry& entry) {
    const Evaluation& evaluation = *entry.evaluation;
    if (entry.as_built && (!evaluation.region || !entry.as_built->loop.robustness.Ms))
        return entry.as_built->loop.robustness.Ms;
    return evaluation.region ? evaluation.region->worst_Ms : evaluation.robustness.Ms;
}

// Why the responses do not come to rest where they should; empty where they do.
std::string unrest(const Performance& performance) {
    for (const Figure* figure : {&performance.setpoint.settling_time, &performance.load.recovery_time,
                                 &performance.setpoint.IAE, &performance.load.IAE})
        if (!*figure) return figure->why.empty() ? "The response does not come to rest." : figure->why;
    return {};
}

std::string above(const TuningEntry& entry, const Figure& Ms, double limit) {
    const bool several = entry.evaluation->region.has_value();
    if (Ms)
        return std::string(several ? "On the worst plant that it must serve Ms is " : "Ms is ") + text(*Ms) +
               ", above " + text(limit) + ".";
    if (entry.as_built && !entry.as_built->loop.robustness.stable)
        return "The loop is unstable as the user's controller computes it.";
    return several ? "The loop is unstable on some plant that it must serve." : "The loop has no Ms.";
}

std::optional<double> baseline_limit(const std::vector<TuningEntry>& entries) {
    std::optional<double> loosest;
    for (const TuningEntry& entry : entries) {
        if (!entry.evaluation || entry.method == "baseline") continue;
        if (!entry.asked_Ms) return std::nullopt;
        loosest = std::max(*entry.asked_Ms, loosest.value_or(0));
    }
    return loosest;
}

Standing standing_of(const TuningEntry& entry, std::optional<double> own, const RankingTerms& terms) {
    const Evaluation& evaluation = *entry.evaluation;
    Standing standing;
    standing.Ms = judged_Ms(entry);
    const auto within = [&](double limit, double tolerance) {
        return standing.Ms && *standing.Ms <= tolerance * limit;
    };
    standing.within = !own || within(*own, kOwnTolerance);
    const std::string restless = terms.over_time ? unrest(evaluation.performance) : "";
    standing.settles = evaluation.robustness.stable && restless.empty();
    if (!evaluation.robustness.stable)
        standing.why = "The loop is unstable.";
    else if (!standing.settles)
        standing.why = restless;
    else if (!standing.within)
        standing.why = above(entry, standing.Ms, *own);
    else if (!within(terms.rank_Ms, kRankTolerance))
        standing.why = above(entry, standing.Ms, terms.rank_Ms);
    return standing;
}

// The optimum at the entry's Ms, or where there is none (limits that no controller meets) that at the nearest Ms.
std::optional<double> optimum_for(const TuningEntry& entry, const std::vector<TuningEntry>& entries) {
    if (entry.optimum_at_Ms && entry.optimum_at_Ms->IAE) return *entry.optimum_at_Ms->IAE;
    const auto& Ms = entry.evaluation->robustness.Ms;
    std::optional<double> nearest;
    double distance = kInfinity;
    for (const TuningEntry& other : entries) {
        if (!Ms || !other.optimum_at_Ms || !other.optimum_at_Ms->IAE) continue;
        const double apart = std::abs(*other.evaluation->robustness.Ms - *Ms);
        if (apart >= distance) continue;
        distance = apart;
        nearest = *other.optimum_at_Ms->IAE;
    }
    return nearest;
}

bool compared(const std::vector<TuningEntry>& entries) {
    return std::ranges::any_of(
        entries, [](const TuningEntry& entry) { return entry.standing && entry.standing->excess_percent.has_value(); });
}

auto key(const TuningEntry& entry) {
    const Standing& standing = *entry.standing;
    const auto& IAE = entry.evaluation->performance.load.IAE;
    return std::tuple(!entry.evaluation->robustness.stable, !standing.settles, !standing.holds(),
                      standing.excess_percent.value_or(kInfinity), IAE ? *IAE : kInfinity);
}

}  // namespace

std::vector<int> ranked(std::vector<TuningEntry>& entries, const RankingTerms& terms) {
    const auto of_baseline = baseline_limit(entries);
    std::vector<int> order;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        TuningEntry& entry = entries[i];
        if (!entry.evaluation) continue;
        order.push_back(static_cast<int>(i));
        entry.standing = standing_of(entry, entry.method == "baseline" ? of_baseline : entry.asked_Ms, terms);
        const auto optimum = optimum_for(entry, entries);
        // The plant's own load IAE, of a nonlinear one too: figures of the linearisation would hide what it does.
        const auto& IAE = entry.evaluation->performance.load.IAE;
        entry.standing->excess_percent = optimum && IAE && *optimum > 0
                                             ? Figure(100 * (*IAE / *optimum - 1))
                                             : no_figure("It was not compared with an optimum.");
    }
    std::ranges::stable_sort(order, {}, [&](int i) { return key(entries[static_cast<std::size_t>(i)]); });
    return order;
}

std::string ranking_by(const std::vector<TuningEntry>& entries, const RankingTerms& terms) {
    const std::string what =
        compared(entries) ? "excess of the load IAE over the least at the same Ms" : std::string("load IAE");
    return what + ", among stable entries that settle with Ms <= " + text(terms.rank_Ms) + ", then the rest";
}

}  // namespace tunewright
