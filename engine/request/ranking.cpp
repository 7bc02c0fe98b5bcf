#include "engine/request/ranking.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "engine/number_text.h"
#include "engine/tuning/limits.h"

namespace tunewright {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Ms of the loop that will run: on the worst plant that the controller must serve, and as the user's controller
// computes it. Empty where one of these has none.
Figure judged_Ms(const TuningEntry& entry) {
    const Evaluation& evaluation = *entry.evaluation;
    const Figure& runs = entry.on_device ? entry.on_device->loop.robustness.Ms : evaluation.robustness.Ms;
    if (!runs) return runs;
    if (const auto& region = region_of(entry); region && !region->worst_Ms) return region->worst_Ms;
    return Figure(worst_Ms(entry)->value);
}

// The reason why the responses do not settle at their targets; empty if they do.
std::string unrest(const Performance& performance) {
    for (const Figure* figure : {&performance.setpoint.settling_time, &performance.load.recovery_time,
                                 &performance.setpoint.IAE, &performance.load.IAE})
        if (!*figure) return figure->why.empty() ? "The response does not settle." : figure->why;
    return {};
}

std::string above(const TuningEntry& entry, const Figure& Ms, double limit) {
    const bool several = region_of(entry).has_value();
    if (Ms)
        return std::string(worst_Ms(entry)->on_worst_plant() ? "On the worst plant Ms is " : "Ms is ") + text(*Ms) +
               ", above " + text(limit) + ".";
    if (entry.on_device && !entry.on_device->loop.robustness.stable) return "The implemented loop is unstable.";
    return several ? "The loop is unstable on at least one of the plants." : "The loop has no Ms.";
}

// The limit on Ms of given settings: the loosest of the designs', if each has one.
std::optional<double> given_limit(const std::vector<TuningEntry>& entries) {
    std::optional<double> loosest;
    for (const TuningEntry& entry : entries) {
        if (!entry.evaluation || entry.is_given()) continue;
        if (!entry.asked_Ms) return std::nullopt;
        loosest = std::max(*entry.asked_Ms, loosest.value_or(0));
    }
    return loosest;
}

Standing standing_of(const TuningEntry& entry, std::optional<double> own, const RankingTerms& terms) {
    const Evaluation& evaluation = *entry.evaluation;
    Standing standing;
    standing.Ms = judged_Ms(entry);
    standing.within = !own || (standing.Ms && !worst_Ms(entry)->exceeds(*own));
    const std::string restless = terms.over_time ? unrest(evaluation.performance) : "";
    standing.settles = evaluation.robustness.stable && restless.empty();
    standing.min_limit = standing.settles && standing.within && standing.Ms
                             ? Figure(*standing.Ms / (1 + limits::kMaxRelativeExcessRanked))
                             : no_figure("No limit on Ms would include it.");
    const auto behind = [&](StandingGroup group, std::string why) {
        standing.group = group;
        standing.why = std::move(why);
        return standing;
    };
    if (!evaluation.robustness.stable) return behind(StandingGroup::unstable, "The loop is unstable.");
    if (!standing.settles) return behind(StandingGroup::not_settled, restless);
    if (!standing.within) return behind(StandingGroup::above_limit, above(entry, standing.Ms, *own));
    if (!standing.min_limit || *standing.min_limit > terms.rank_Ms)
        return behind(StandingGroup::above_limit, above(entry, standing.Ms, terms.rank_Ms));
    standing.group = StandingGroup::holds;
    return standing;
}

// The optimum at the entry's Ms. If there is none (no controller meets such limits), the optimum at the nearest Ms.
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
    return std::tuple(standing.group, standing.excess_percent.value_or(kInfinity),
                      entry.evaluation->performance.load.IAE.value_or(kInfinity));
}

// The sort key without the limits on Ms.
auto key_without_limits(const TuningEntry& entry) {
    auto without = key(entry);
    if (std::get<0>(without) == StandingGroup::above_limit) std::get<0>(without) = StandingGroup::holds;
    return without;
}

}  // namespace

RankingTerms ranking_terms(const EvaluateOptions& options, bool over_time) {
    return {options.rank_Ms.value_or(limits::kDefaultMaxRankedMs), over_time};
}

std::vector<int> ranked(std::vector<TuningEntry>& entries, const RankingTerms& terms) {
    const auto of_given = given_limit(entries);
    std::vector<int> order;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        TuningEntry& entry = entries[i];
        if (!entry.evaluation) continue;
        order.push_back(static_cast<int>(i));
        entry.standing = standing_of(entry, entry.is_given() ? of_given : entry.asked_Ms, terms);
        const auto optimum = optimum_for(entry, entries);
        // Its own load IAE for a nonlinear plant too: the figures of the linearisation would hide its behaviour.
        const auto& IAE = entry.evaluation->performance.load.IAE;
        entry.standing->excess_percent = optimum && IAE && *optimum > 0
                                             ? Figure(100 * (*IAE / *optimum - 1))
                                             : no_figure("It was not compared with an optimum.");
    }
    const auto entry_at = [&](int i) -> TuningEntry& { return entries[static_cast<std::size_t>(i)]; };
    auto by_merit = order;
    std::ranges::stable_sort(by_merit, {}, [&](int i) { return key_without_limits(entry_at(i)); });
    for (std::size_t place = 0; place < by_merit.size(); ++place)
        entry_at(by_merit[place]).standing->order = static_cast<int>(place) + 1;
    std::ranges::stable_sort(order, {}, [&](int i) { return key(entry_at(i)); });
    return order;
}

std::string ranking_by(const std::vector<TuningEntry>& entries, const RankingTerms& terms) {
    const std::string what =
        compared(entries) ? "excess of the load IAE over the least at the same Ms" : std::string("load IAE");
    return what + ", among stable entries that settle with Ms <= " + text(terms.rank_Ms) + ", then the rest";
}

}  // namespace tunewright
