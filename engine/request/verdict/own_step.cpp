#include <algorithm>
#include <cmath>

#include "engine/request/verdict/findings.h"

namespace tunewright::verdict {
namespace {

/// A limit of u at which the step spends time.
struct ReachedLimit {
    double value = 0;
    Figure time;
    const char* name;  ///< of the time in the answer
};

std::optional<ReachedLimit> reached_limit(const OwnStep& step, const OwnStepEntry& entry) {
    const auto spent = [](const Figure& time) { return !time || *time > 0; };
    const bool at_max = step.u_max && spent(entry.time_at_max), at_min = step.u_min && spent(entry.time_at_min);
    if (at_max && (!at_min || entry.time_at_max.value_or(INFINITY) >= entry.time_at_min.value_or(INFINITY)))
        return ReachedLimit{*step.u_max, entry.time_at_max, "time_at_max"};
    if (at_min) return ReachedLimit{*step.u_min, entry.time_at_min, "time_at_min"};
    return {};
}

/// The limit beyond which u would have to be to hold the target.
std::optional<double> exceeded_limit(const OwnStep& step, const OwnStepEntry& entry) {
    if (!entry.u_needed) return {};
    const double tolerance = kRelativeLimitRounding * std::max(std::abs(*entry.u_needed), std::abs(step.u));
    if (step.u_max && *entry.u_needed > *step.u_max + tolerance) return step.u_max;
    if (step.u_min && *entry.u_needed < *step.u_min - tolerance) return step.u_min;
    return {};
}

Finding out_of_reach(const OwnStep& step, const OwnStepEntry& entry, double limit, const LinearPlant& plant,
                     const Labels& labels) {
    const bool bounded = stays_bounded(plant);
    FindingBuilder draft("own-step-out-of-reach", bounded ? Level::warning : Level::bad);
    draft.say("No controller can hold the target of your step: ")
        .number("target", step.target, printed_unit(labels.y))
        .say(step.load && step.load->shape != LoadShape::pulse ? " after the load needs u = " : " needs u = ")
        .number("u_needed", *entry.u_needed, printed_unit(labels.u))
        .say(", and the limit is ")
        .number("u_limit", limit, printed_unit(labels.u));
    if (entry.y_final) draft.say("; y rests at ").number("y_final", *entry.y_final, printed_unit(labels.y));
    if (!bounded) draft.say("; y grows without bound");
    return draft.say(".");
}

void say_saturation(FindingBuilder& draft, const ReachedLimit& limit, const Labels& labels) {
    draft.say(limit.time ? " u is at its limit of " : " u stays at its limit of ")
        .number("u_limit", limit.value, printed_unit(labels.u));
    if (limit.time) draft.say(" for ").number(limit.name, *limit.time, printed_unit(labels.time));
    draft.say(".");
}

void say_setpoint(FindingBuilder& draft, const OwnStep& step, const OwnStepEntry& entry, const Labels& labels) {
    const OwnSetpointFigures& figures = *entry.setpoint;
    draft.say("Your step from ")
        .number("y", step.y, printed_unit(labels.y))
        .say(" to ")
        .number("target", step.target, printed_unit(labels.y));
    const bool overshoots = figures.overshoot && *figures.overshoot > 0;
    draft.say(overshoots ? " overshoots by " : " does not overshoot");
    if (overshoots) draft.number("overshoot", *figures.overshoot, printed_unit(labels.y));
    if (figures.settling_time)
        draft.say(" and settles within ").number("settling_time", *figures.settling_time, printed_unit(labels.time));
    else
        draft.say(step.load ? " and has not settled when the load comes" : " and does not settle");
    draft.say(".");
}

void say_load(FindingBuilder& draft, const OwnStepEntry& entry, const Labels& labels) {
    const OwnLoadFigures& figures = *entry.load;
    if (!figures.peak) return;
    draft.say(entry.setpoint ? " The load moves y by " : "Your load moves y by ")
        .number("peak", *figures.peak, printed_unit(labels.y));
    if (figures.recovery_time)
        draft.say(", for ").number("recovery_time", *figures.recovery_time, printed_unit(labels.time));
    draft.say(".");
}

}  // namespace

OptionalFinding own_step(const VerdictInput& c) {
    const auto& entry = c.entry.own_step;
    const OwnStep* step = c.context.own_step;
    if (!entry || entry->refused || step == nullptr) return {};
    const Labels& labels = c.context.labels;
    if (c.has_integral())
        if (const auto limit = exceeded_limit(*step, *entry))
            return out_of_reach(*step, *entry, *limit, *c.context.subject.linear(), labels);
    const auto limit = reached_limit(*step, *entry);
    FindingBuilder draft(limit ? "own-step-saturates" : "own-step", Level::note);
    if (entry->setpoint) say_setpoint(draft, *step, *entry, labels);
    if (entry->load) say_load(draft, *entry, labels);
    if (limit) say_saturation(draft, *limit, labels);
    return draft;
}

}  // namespace tunewright::verdict
