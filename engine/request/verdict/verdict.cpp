#include "engine/request/verdict/verdict.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "engine/request/verdict/findings.h"

namespace tunewright::verdict {
namespace {

const TuningEntry* todays(const std::vector<TuningEntry>& entries) {
    for (const TuningEntry& entry : entries)
        if (entry.is_baseline() && entry.evaluation) return &entry;
    return nullptr;
}

/// Reports a small overshoot; a large one is among the primary_findings.
OptionalFinding small_overshoot(const VerdictInput& c) {
    return overshoot_level(c) == Level::note ? overshoot(c) : OptionalFinding{};
}

/// Gives the note; for steps that the request sets, the finding is among the primary_findings.
OptionalFinding actuator_too_small_as_assumed(const VerdictInput& c) {
    auto finding = actuator_too_small(c);
    return finding && finding->level == Level::note ? finding : OptionalFinding{};
}

std::vector<Finding> verdict_on(const TuningEntry& entry, const TuningEntry* today, const Context& context) {
    if (!entry.evaluation) return entry.error ? no_controller(*entry.error) : std::vector<Finding>{};
    const VerdictInput c{entry, &entry == today ? nullptr : today, context};
    std::vector<Finding> verdict = primary_findings(c);
    const auto add = [&](OptionalFinding found) {
        if (found) verdict.push_back(std::move(*found));
    };
    if (!c.evaluation.robustness.stable) {
        for (const auto& finding : {all_members, dead_time_rules}) add(finding(c));
        return verdict;
    }
    const auto after_heads = static_cast<std::ptrdiff_t>(verdict.size());
    if (!c.robustness().stable) {
        for (const auto& finding : {on_device, sample_time, all_members}) add(finding(c));
        return verdict;
    }
    for (const auto& finding : {active_limit,
                                all_members,
                                margins,
                                nonlinear_margins,
                                large_errors,
                                load_error,
                                replayed,
                                own_step,
                                on_device,
                                at_its_limits,
                                actuator_too_small_as_assumed,
                                movement,
                                noise,
                                sample_time,
                                small_overshoot,
                                PI_or_PID,
                                excess,
                                proved,
                                dead_time_rules,
                                filter_rules})
        add(finding(c));
    std::stable_sort(verdict.begin() + after_heads, verdict.end(), [](const Finding& a, const Finding& b) {
        return (a.level >= Level::warning) > (b.level >= Level::warning);
    });
    return verdict;
}

Level level_of(const TuningEntry& entry) { return entry.verdict.front().level; }

/// An entry that may be chosen, with the quantities that decide.
struct Candidate {
    int index = 0;
    bool held = false, valid = false;
    Level level = Level::good;
    double load_IAE = INFINITY;

    std::pair<bool, bool> group() const { return {!held, !valid}; }
};

bool has(const std::vector<Finding>& findings, const char* code) {
    return std::ranges::any_of(findings, [&](const Finding& finding) { return finding.code == code; });
}

/// The loosest limit on Ms that was set for a design; 0: none.
double asked_limit(const std::vector<TuningEntry>& entries) {
    double loosest = 0;
    for (const TuningEntry& entry : entries)
        if (entry.evaluation && !entry.is_baseline()) loosest = std::max(loosest, entry.asked_Ms.value_or(0));
    return loosest;
}

/// Little margin is no disadvantage if the request allowed it for this entry.
Level level_for_choice(const TuningEntry& entry, double asked_Ms) {
    const bool as_asked = entry.standing && entry.standing->Ms && !worst_Ms(entry)->exceeds(asked_Ms);
    Level level = Level::good;
    for (const Finding& finding : entry.verdict)
        if (finding.head && !(as_asked && finding.code == "little-margin")) level = std::max(level, finding.level);
    return level;
}

Candidate candidate(const TuningEntry& entry, int index, double asked_Ms) {
    const auto outside = [](const Warning& warning) { return warning.code == "outside-validity"; };
    return {.index = index,
            .held = !has(entry.verdict, "above-limit") && (!entry.standing || entry.standing->holds()),
            .valid = std::ranges::none_of(entry.evaluation->warnings, outside),
            .level = level_for_choice(entry, asked_Ms),
            .load_IAE = performance_of(entry).load.IAE.value_or(INFINITY)};
}

/// The entry to choose; -1 if none is usable. The first group keeps the limits and is within its rule's validity. An
/// entry that costs many times as much as another of its group drops out; the rest is ordered by level, then by rank.
int choice(const std::vector<TuningEntry>& entries, const std::vector<int>& ranking) {
    std::vector<Candidate> left;
    for (const int index : ranking) {
        const TuningEntry& entry = entries[static_cast<std::size_t>(index)];
        if (entry.is_baseline() || !entry.evaluation || level_of(entry) == Level::bad) continue;
        left.push_back(candidate(entry, index, asked_limit(entries)));
    }
    if (left.empty()) return -1;
    const auto first = std::ranges::min(left, {}, &Candidate::group).group();
    std::erase_if(left, [&](const Candidate& one) { return one.group() != first; });
    const double min = std::ranges::min(left, {}, &Candidate::load_IAE).load_IAE;
    std::erase_if(left, [&](const Candidate& one) { return one.load_IAE > kManyFold * min; });
    return std::ranges::min_element(left, {}, &Candidate::level)->index;
}

std::string name_of(const TuningEntry& entry, int index) {
    return entry.title.empty() ? "controller " + std::to_string(index + 1) : entry.title;
}

Finding none_to_take(const std::vector<TuningEntry>& entries, const std::vector<int>& ranking) {
    const auto designs = std::ranges::count_if(entries, [](const TuningEntry& e) { return !e.is_baseline(); });
    if (designs == 1 && !ranking.empty()) {
        const auto own = std::ranges::find_if(entries, [](const TuningEntry& e) { return !e.is_baseline(); });
        return FindingBuilder("none", Level::bad).say(own->verdict.front().text);
    }
    return FindingBuilder("none", Level::bad).say("None of these controllers should be used.");
}

/// Today's settings are kept if they are as safe and a change gains nothing.
bool keeps_today(const TuningEntry& best, const TuningEntry* today) {
    if (today == nullptr || today->verdict.empty() || level_of(*today) > level_of(best)) return false;
    const Figure &IAE = performance_of(best).load.IAE, &before = performance_of(*today).load.IAE;
    return IAE && before && *IAE > kMaxIaeOverToday * *before;
}

}  // namespace

void judge(std::vector<TuningEntry>& entries, const Context& context) {
    const TuningEntry* today = todays(entries);
    for (TuningEntry& entry : entries) entry.verdict = verdict_on(entry, today, context);
}

std::vector<Finding> of_all(const std::vector<TuningEntry>& entries, const std::vector<int>& ranking,
                            const Context& context, bool partial) {
    if (entries.empty()) return {};
    std::vector<Finding> verdict;
    const int index = choice(entries, ranking);
    const TuningEntry* today = todays(entries);
    if (index < 0) {
        verdict.push_back(none_to_take(entries, ranking));
    } else {
        const TuningEntry& best = entries[static_cast<std::size_t>(index)];
        const bool keep = keeps_today(best, today);
        const std::string words = best.verdict.front().text;
        if (keep)
            verdict.push_back(FindingBuilder("keep-today", Level::good)
                                  .say("No controller here rejects loads better: keep today's settings.")
                                  .figure("entry", index));
        else
            verdict.push_back(Finding{"take", level_of(best), "Take " + name_of(best, index) + ". " + words,
                                      best.verdict.front().figures});
        verdict.front().figures["entry"] = index;
        const VerdictInput c{best, today, context};
        if (auto error = load_error(c)) verdict.push_back(std::move(*error));
    }
    if (partial)
        verdict.push_back(FindingBuilder("stopped-early", Level::note)
                              .say("Stopped early: this is the best controller found so "
                                   "far."));
    return verdict;
}

std::optional<int> proposed(const std::vector<TuningEntry>& entries, const std::vector<Finding>& of_all) {
    if (!of_all.empty())
        if (const auto named = of_all.front().figures.find("entry"); named != of_all.front().figures.end())
            return static_cast<int>(named->second);
    const auto first = std::ranges::find_if(entries, [](const TuningEntry& e) { return e.evaluation || e.unjudged; });
    if (first == entries.end()) return std::nullopt;
    return static_cast<int>(first - entries.begin());
}

std::vector<Finding> no_controller(const Error& error) {
    const bool limits = error.kind == ErrorKind::no_feasible_controller;
    return {FindingBuilder("no-controller", Level::bad)
                .say(limits ? "No controller meets these limits." : "This method gives no controller here."),
            FindingBuilder("reason", Level::note).say(error.message)};
}

std::vector<Finding> without_loop(const Controller& controller, double Ku, const std::vector<Warning>& remarks) {
    FindingBuilder unknown("robustness-unknown", Level::warning);
    unknown.say(
        "The robustness of this loop is unknown: Ms, margins and responses need more than Ku and Pu, namely a model of "
        "the plant or a recorded test.");
    if (const auto* pid = std::get_if<IdealPid>(&controller))
        unknown.say(" Kp is ").number("Kp_over_Ku", pid->Kp / Ku).say(" of Ku, the gain at which the loop oscillates.");
    std::vector<Finding> verdict{unknown};
    for (const Warning& remark : remarks) verdict.push_back(FindingBuilder("reason", Level::note).say(remark.detail));
    return verdict;
}

std::vector<Finding> of_all_without_loop() {
    return {FindingBuilder("robustness-unknown", Level::warning)
                .say("Ku and Pu alone give settings but no figures of the loop. Record the test, or give a model of "
                     "the plant, to see which settings are robust.")};
}

}  // namespace tunewright::verdict
