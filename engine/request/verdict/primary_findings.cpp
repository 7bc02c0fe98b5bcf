#include <algorithm>
#include <cmath>
#include <string>

#include "engine/identification/model_grade.h"
#include "engine/request/verdict/findings.h"
#include "engine/tuning/limits.h"

namespace tunewright::verdict {
namespace {

using OptionalFinding = std::optional<Finding>;

constexpr double kRelativeRounding = 1e-6;

OptionalFinding unstable(const VerdictInput& c) {
    if (c.evaluation.robustness.stable) return {};
    return FindingBuilder("unstable", Level::bad)
        .say(c.is_today() ? "Today's settings are unstable on this plant."
                          : "The loop is unstable: do not use these settings.");
}

OptionalFinding unstable_on_device(const VerdictInput& c) {
    if (!c.on_device() || c.robustness().stable || !c.evaluation.robustness.stable) return {};
    return FindingBuilder("unstable-as-built", Level::bad).say("Unstable on your controller.");
}

OptionalFinding unstable_member(const VerdictInput& c) {
    const auto& region = c.region();
    if (!region || (region->worst_Ms && region->stable_fraction >= 1)) return {};
    if (c.context.model != nullptr)
        return FindingBuilder("model-too-uncertain", Level::bad)
            .say(
                "The model is too uncertain for these settings: the loop is unstable for a part of its confidence "
                "region.");
    return FindingBuilder("unstable-member", Level::bad).say("Unstable for a part of the plant's uncertainty.");
}

/// True if both responses settle at their targets, except for steps that no controller can follow or reject.
bool rests(const Performance& p, const StepsBeyondActuator& beyond) {
    return (p.setpoint.settling_time || beyond.setpoint) && (p.load.recovery_time || beyond.load);
}

/// A response that is cut off by the horizon may still settle.
OptionalFinding not_settling(const VerdictInput& c) {
    const Performance& p = c.evaluation.performance;
    if (!c.evaluation.robustness.stable || c.context.subject.measured() != nullptr) return {};
    if (c.warned_of("left-domain"))
        return FindingBuilder("not-settling", Level::bad).say("A response leaves the domain of the equations.");
    if (!c.has_integral()) return {};
    const StepsBeyondActuator beyond = steps_beyond_actuator(c);
    const bool excused = beyond.setpoint || beyond.load;
    if (rests(p, beyond) && (excused || !c.warned_of("does-not-settle"))) return {};
    if (c.context.options.horizon)
        return FindingBuilder("short-horizon", Level::warning)
            .say("The responses have not settled at the end of the requested time.");
    return FindingBuilder("not-settling", Level::bad).say("The response does not settle.");
}

OptionalFinding too_sharp(const VerdictInput& c) {
    const auto worst = c.worst_Ms();
    if (!worst || worst->value <= kTooSharpMs * (1 + kRelativeRounding)) return {};
    return FindingBuilder("too-sharp", Level::bad)
        .say("Too little margin for a plant that changes: Ms ")
        .number("Ms", worst->value)
        .say(words_of(worst->loop) + ".");
}

OptionalFinding above_limit(const VerdictInput& c) {
    const RequestedLimits limits = c.limits();
    const auto worst = c.worst_Ms(), Mt = c.worst_Mt();
    const auto broken = [](const char* name, const PlacedPeak& peak, double limit) -> Finding {
        return FindingBuilder("above-limit", Level::warning)
            .say(std::string("Above the requested limit: ") + name + " ")
            .number(name, peak.value)
            .say(words_of(peak.loop) + " instead of ")
            .number(std::string(name) + "_limit", limit)
            .say(".");
    };
    if (worst && limits.Ms && worst->exceeds(*limits.Ms)) return broken("Ms", *worst, *limits.Ms);
    if (Mt && limits.Mt && Mt->exceeds(*limits.Mt)) return broken("Mt", *Mt, *limits.Mt);
    return {};
}

OptionalFinding little_margin(const VerdictInput& c) {
    const auto worst = c.worst_Ms();
    if (!worst || worst->value <= kLittleMarginMs * (1 + kRelativeRounding) ||
        worst->value > kTooSharpMs * (1 + kRelativeRounding))
        return {};
    return FindingBuilder("little-margin", Level::warning)
        .say("Fast, with little margin left: Ms ")
        .number("Ms", worst->value)
        .say(words_of(worst->loop) + ".");
}

OptionalFinding oscillatory(const VerdictInput& c) {
    const auto Mt = c.worst_Mt();
    if (!Mt || Mt->value <= kOscillatoryMt * (1 + kRelativeRounding)) return {};
    return FindingBuilder("oscillatory", Level::warning)
        .say("It oscillates before it settles: Mt ")
        .number("Mt", Mt->value)
        .say(words_of(Mt->loop) + ".");
}

OptionalFinding doubtful_model(const VerdictInput& c) {
    const auto doubt = c.context.model != nullptr ? reason_of_doubt(*c.context.model) : std::nullopt;
    if (!doubt) return {};
    if (*doubt == DoubtReason::warning)
        return FindingBuilder("doubtful-model", Level::warning).say("The model is doubtful: see its warnings.");
    return FindingBuilder("doubtful-model", Level::warning)
        .say("The model is doubtful: it explains only ")
        .number("fit_percent", c.context.model->fit_percent, "%")
        .say(" of the record's movement.");
}

OptionalFinding costly_region(const VerdictInput& c) {
    if (!c.entry.region_cost || *c.entry.region_cost <= kMaxRegionCost) return {};
    return FindingBuilder("costly-region", Level::warning)
        .say("The record leaves a large uncertainty: a design that keeps the limit for all of it has ")
        .number("region_cost", *c.entry.region_cost)
        .say(" times the load error of a design for the model alone. A better test would reduce it.");
}

OptionalFinding restless_on_device(const VerdictInput& c) {
    if (!c.on_device() || !c.robustness().stable || c.context.options.horizon || !c.has_integral()) return {};
    if (rests(c.performance(), steps_beyond_actuator(c))) return {};
    return FindingBuilder("restless-as-built", Level::warning).say("On your controller the response does not settle.");
}

/// As a note it follows after the primary findings.
OptionalFinding actuator_too_small_as_asked(const VerdictInput& c) {
    auto finding = actuator_too_small(c);
    return finding && finding->level >= Level::warning ? finding : OptionalFinding{};
}

OptionalFinding large_overshoot(const VerdictInput& c) {
    return overshoot_level(c) == Level::warning ? overshoot(c) : OptionalFinding{};
}

OptionalFinding not_on_device(const VerdictInput& c) {
    if (!c.warned_of("not-as-built")) return {};
    return FindingBuilder("not-as-built", Level::warning)
        .say("The loop on your controller is unknown; only the ideal loop was evaluated.");
}

OptionalFinding no_integral(const VerdictInput& c) {
    if (!c.evaluation.robustness.stable || c.has_integral()) return {};
    return FindingBuilder("no-integral", Level::warning)
        .say(
            "Without integral action, a load leaves a steady-state "
            "error.");
}

OptionalFinding margin_unknown(const VerdictInput& c) {
    const bool known = c.robustness().Ms.has_value() && c.evaluation.robustness.Ms.has_value();
    if (known || !c.robustness().stable) return {};
    return FindingBuilder("margin-unknown", Level::warning).say("Stable; margin unknown.");
}

Finding robust(const VerdictInput& c) {
    if (c.is_today()) return FindingBuilder("robust", Level::good).say("Today's settings are robust.");
    const auto active = active_limits(c);
    if (active.empty()) return FindingBuilder("robust", Level::good).say("Robust.");
    return FindingBuilder("robust", Level::good)
        .say(active.front().name == "Mks" ? "Robust, limited by the requested noise gain."
                                          : "Robust, limited by the requested margin.");
}

}  // namespace

std::vector<Finding> primary_findings(const VerdictInput& c) {
    std::vector<Finding> found;
    for (const auto& head : {unstable, unstable_on_device, unstable_member, not_settling, too_sharp, above_limit,
                             actuator_too_small_as_asked, little_margin, doubtful_model, costly_region, oscillatory,
                             large_overshoot, restless_on_device, not_on_device, no_integral, margin_unknown})
        if (auto finding = head(c)) found.push_back(std::move(*finding));
    if (found.empty()) found.push_back(robust(c));
    for (Finding& finding : found) finding.head = true;
    std::ranges::stable_sort(found, [](const Finding& a, const Finding& b) { return a.level > b.level; });
    return found;
}

std::vector<ActiveLimit> active_limits(const VerdictInput& c) {
    const RequestedLimits limits = c.limits();
    const Robustness& r = c.robustness();
    const auto reached = [](const std::optional<double>& value, const std::optional<double>& limit) {
        return value && limit && std::abs(*value / *limit - 1) <= limits::kMaxRelativeExcessShown;
    };
    std::vector<ActiveLimit> active;
    if (reached(r.Ms, limits.Ms)) active.push_back({"Ms", *r.Ms, r.omega_Ms, ""});
    if (reached(r.Mt, limits.Mt)) active.push_back({"Mt", *r.Mt, r.omega_Mt, ""});
    if (reached(r.Mks, limits.Mks)) active.push_back({"Mks", *r.Mks, {}, ""});
    const auto& region = c.region();
    if (active.empty() && region && reached(region->worst_Ms, limits.Ms))
        active.push_back({"Ms", *region->worst_Ms, {}, " on the worst plant"});
    return active;
}

}  // namespace tunewright::verdict
