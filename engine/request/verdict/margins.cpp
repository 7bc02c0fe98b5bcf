#include "engine/request/verdict/findings.h"
#include "engine/tuning/limits.h"

#include <algorithm>
#include <cmath>

namespace tunewright::verdict {
namespace {

std::string frequency_unit(const VerdictInput& c) { return "rad/" + c.context.labels.time; }

void say_place(FindingBuilder& draft, const std::string& name, const std::optional<double>& omega,
               const VerdictInput& c) {
    if (omega && *omega > 0) draft.say(" at ").number("omega_" + name, *omega, frequency_unit(c));
}

/// " Mt (1.31) is within its limit."
void say_within(FindingBuilder& draft, const std::string& name, const Figure& value,
                const std::optional<double>& limit) {
    if (!value) return;
    if (!limit) {
        draft.say(" " + name + " is ").number(name, *value).say(".");
    } else if (*value <= *limit * (1 + limits::kMaxRelativeExcessShown)) {
        draft.say(" " + name + " (").number(name, *value).say(") is within its limit.").figure(name + "_limit", *limit);
    }
}

Finding peaks(const VerdictInput& c) {
    const Robustness& r = c.robustness();
    FindingBuilder draft("peaks", Level::note);
    draft.say("Ms is ").number("Ms", *r.Ms);
    say_place(draft, "Ms", r.omega_Ms, c);
    if (r.Mt) draft.say(", Mt ").number("Mt", *r.Mt);
    return draft.say(".");
}

}  // namespace

OptionalFinding on_device(const VerdictInput& c) {
    if (!c.on_device()) return {};
    const DeviceEntry& on_device = *c.entry.on_device;
    const Robustness &ideal = c.evaluation.robustness, &runs = on_device.loop.robustness;
    if (!runs.stable) return FindingBuilder("as-built", Level::note).say("Only the ideal loop is stable.");
    if (!runs.Ms || !ideal.Ms) return {};
    const bool worse = on_device.Ms_percent.value_or(0) > kWorsePercent_Ms ||
                       on_device.load_IAE_percent.value_or(0) > kWorsePercent_IAE;
    FindingBuilder draft("as-built", worse ? Level::warning : Level::note);
    draft.say("On your controller Ms is ")
        .number("Ms", *runs.Ms)
        .say(" (")
        .number("Ms_ideal", *ideal.Ms)
        .say(" for the ideal loop)");
    const Figure &IAE = on_device.loop.performance.load.IAE, &before = c.evaluation.performance.load.IAE;
    if (IAE && before)
        draft.say(" and the load IAE ").number("load_IAE", *IAE).say(" (").number("load_IAE_ideal", *before).say(")");
    return draft.say(".");
}

OptionalFinding active_limit(const VerdictInput& c) {
    const Robustness& r = c.robustness();
    const auto active = active_limits(c);
    if (active.empty()) return r.Ms ? OptionalFinding(peaks(c)) : std::nullopt;
    const RequestedLimits limits = c.limits();
    FindingBuilder draft("active-limit", Level::note);
    draft.say(active.size() == 1   ? "The active limit is "
              : active.size() == 2 ? "Both limits are active: "
                                   : "All limits are active: ");
    for (std::size_t i = 0; i < active.size(); ++i) {
        const auto& [name, value, omega, where] = active[i];
        if (i > 0) draft.say(i + 1 == active.size() ? " and " : ", ");
        const std::string unit = name == "Mks" ? quotient_unit(c.context.labels.u, c.context.labels.y) : "";
        draft.say(name == "Mks" ? "the noise gain Mks = " : name + " = ").number(name, value, unit);
        say_place(draft, name, omega, c);
        draft.say(where);
    }
    draft.say(".");
    const auto is_active = [&](const std::string& name) {
        for (const auto& limit : active)
            if (limit.name == name) return true;
        return false;
    };
    if (!is_active("Ms")) say_within(draft, "Ms", r.Ms, limits.Ms);
    if (!is_active("Mt")) say_within(draft, "Mt", r.Mt, limits.Mt);
    return draft;
}

OptionalFinding all_members(const VerdictInput& c) {
    const auto& region = c.region();
    if (!region) return {};
    const bool record = c.context.model != nullptr;
    if (region->worst_Ms && region->stable_fraction >= 1)
        return FindingBuilder("members", Level::note)
            .say(record ? "Stable over the whole identified uncertainty, with Ms "
                        : "Stable on all the plants, with Ms ")
            .number("worst_Ms", *region->worst_Ms)
            .say(" at worst.");
    // Rounded down, so that a part is never reported as 100 %.
    const double percent = std::min(99.9, std::floor(1000 * region->stable_fraction) / 10);
    FindingBuilder draft("members", Level::note);
    draft.say("Stable on ").number("stable_percent", percent, "%");
    return draft.say(record ? " of the identified uncertainty." : " of the plants.");
}

OptionalFinding margins(const VerdictInput& c) {
    const auto& [low, high, dead_time] = c.robustness().tolerates;
    FindingBuilder draft("margins", Level::note);
    const bool falls = low && *low > 0;
    if (!falls && !high && !dead_time) return {};
    draft.say(c.region() ? "On the nominal plant " : "");
    const auto subject = [&](const char* name) {
        return (c.region() ? std::string("the ") : std::string("The ")) + name;
    };
    if (falls || high) draft.say(subject("process gain may "));
    if (falls) draft.say("fall to ").number("gain_low", *low).say(" of itself");
    if (falls && high) draft.say(" or ");
    if (high && *high > kUnlimitedGainMargin)
        draft.say("grow by more than ")
            .number("gain_more_than", kUnlimitedGainMargin)
            .say("-fold")
            .figure("gain_high", *high);
    if (high && *high <= kUnlimitedGainMargin) draft.say("grow ").number("gain_high", *high).say("-fold");
    if (dead_time) {
        const bool grows = (falls || high) && !falls;
        draft
            .say(falls || high ? (grows ? ", or the dead time by " : ", or the dead time may grow by ")
                               : subject("dead time may grow by "))
            .number("extra_dead_time", *dead_time, printed_unit(c.context.labels.time));
    }
    return draft.say(", before the loop oscillates.");
}

OptionalFinding nonlinear_margins(const VerdictInput& c) {
    if (std::holds_alternative<Npid>(c.evaluation.controller))
        return FindingBuilder("linear-part", Level::note)
            .say(
                "Ms and the margins belong to the controller's linear part, which acts alone while errors are small "
                "against delta_r; the responses hold for these steps and change with their size.");
    if (c.context.subject.equations() == nullptr) return {};
    const bool far = c.warned_of("far-from-linear");
    return FindingBuilder("linearisation", far ? Level::warning : Level::note)
        .say(far ? "Ms and the margins are those of the linearisation; with these steps the plant is far from it."
                 : "Ms and the margins are those of the linearisation; the responses are the plant's own.");
}

OptionalFinding large_errors(const VerdictInput& c) {
    const auto& nonlinear = c.evaluation.nonlinear;
    if (!nonlinear || nonlinear->statement.empty()) return {};
    return FindingBuilder("large-errors", Level::note).say(nonlinear->statement);
}

}  // namespace tunewright::verdict
