#include <algorithm>
#include <cmath>

#include "engine/evaluation/evaluate_nonlinear.h"
#include "engine/request/verdict/findings.h"

namespace tunewright::verdict {
namespace {

/// What u has to be at rest, and what its limits carry of a step.
struct Need {
    double u = 0;        ///< deviation from the operating point
    double carried = 0;  ///< of the step, with its sign; the largest at rest
};

bool carries(const ActuatorLimits& limits, double u) { return u >= limits.min && u <= limits.max; }

/// A load is at the plant's input: u has to take all of it back.
Need of_load(const ActuatorLimits& limits, double d) { return {-d, d > 0 ? -limits.min : -limits.max}; }

/// With a static gain u has to be r/K; a plant that integrates comes to rest with u at 0.
std::optional<Need> of_setpoint(const LinearPlant& plant, const ActuatorLimits& limits, double r) {
    if (plant.integrators() != 0) return {};
    const double K = plant.low_frequency_gain(), u = r / K;
    return Need{u, K * (u > 0 ? limits.max : limits.min)};
}

/// Of equations: where y comes to rest with u at the limit that it needs more of.
std::optional<Need> of_setpoint(const Case& c, const NonlinearSystem& system, const ActuatorLimits& limits) {
    const SetpointPerformance& p = c.performance().setpoint;
    if (!c.warned_of("actuator-limited") || c.warned_of("does-not-settle") || p.settling_time || p.IAE) return {};
    const double toward = c.context.options.setpoint_step * c.context.subject.linear()->low_frequency_gain();
    const double limit = toward > 0 ? limits.max : limits.min;
    NonlinearPlant at_limit = system.description();
    at_limit.input.nominal = system.u_nominal() + limit;
    const auto rest = NonlinearSystem::make(at_limit);
    if (!rest) return {};
    return Need{std::copysign(INFINITY, toward), rest->y_steady() - system.y_steady()};
}

std::optional<ActuatorLimits> limits_of(const Case& c) {
    const NonlinearSystem* system = c.context.subject.equations();
    return system != nullptr ? limited_as(*system, c.context.options).actuator : c.context.options.actuator;
}

}  // namespace

Found actuator_too_small(const Case& c) {
    const auto limits = limits_of(c);
    const LinearPlant* plant = c.context.subject.linear();
    if (!limits || plant == nullptr || !c.has_integral() || !c.evaluation.robustness.stable ||
        std::holds_alternative<Npid>(c.evaluation.controller))
        return {};
    const EvaluateOptions& options = c.context.options;
    const Labels& labels = c.context.labels;
    const NonlinearSystem* system = c.context.subject.equations();
    const Need load = of_load(*limits, options.load_step);
    const auto setpoint =
        system != nullptr ? of_setpoint(c, *system, *limits) : of_setpoint(*plant, *limits, options.setpoint_step);
    const bool load_fails = !carries(*limits, load.u), setpoint_fails = setpoint && !carries(*limits, setpoint->u);
    if (!load_fails && !setpoint_fails) return {};
    const bool bounded = plant->integrators() <= 0 && plant->unstable_poles() == 0;
    Draft draft("actuator-too-small", bounded ? Level::warning : Level::bad);
    const bool upper = (setpoint_fails ? setpoint->u : load.u) > limits->max;
    draft.say(bounded ? "u rests at its limit of " : "y is unbounded, with u at its limit of ")
        .number("u_limit", upper ? limits->max : limits->min, printed_unit(labels.u))
        .say(": ");
    if (setpoint_fails)
        draft.say("it carries a set-point step of ")
            .number("largest_setpoint_step", setpoint->carried, printed_unit(labels.y))
            .say(" and not of ")
            .number("setpoint_step", options.setpoint_step, printed_unit(labels.y));
    if (load_fails)
        draft.say(setpoint_fails ? ", and a load step of " : "it carries a load step of ")
            .number("largest_load_step", load.carried, printed_unit(labels.u))
            .say(" and not of ")
            .number("load_step", options.load_step, printed_unit(labels.u));
    return draft.say(". No controller changes that.");
}

Found at_its_limits(const Case& c) {
    if (!c.warned_of("actuator-limited")) return {};
    return Draft("at-limits", Level::warning)
        .say(
            "The controller output reaches its limit on these steps; Ms and the margins hold only between the limits.");
}

}  // namespace tunewright::verdict
