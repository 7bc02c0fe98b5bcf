#include <algorithm>
#include <cmath>

#include "engine/evaluation/evaluate_nonlinear.h"
#include "engine/request/verdict/findings.h"

namespace tunewright::verdict {
namespace {

/// The steady-state u that a step needs, and the part of the step that the limits of u allow.
struct Need {
    double u = 0;        ///< deviation from the operating point
    double carried = 0;  ///< part of the step, with its sign: the largest that u can carry in steady state
};

bool carries(const ActuatorLimits& limits, double u) { return u >= limits.min && u <= limits.max; }

/// A load acts at the plant's input: in steady state u must cancel all of it.
Need of_load(const ActuatorLimits& limits, double d) { return {-d, d > 0 ? -limits.min : -limits.max}; }

/// With a static gain u must be r/K in steady state; a plant that integrates comes to rest with u at 0.
std::optional<Need> of_setpoint(const LinearPlant& plant, const ActuatorLimits& limits, double r) {
    if (plant.integrators() != 0) return {};
    const double K = plant.low_frequency_gain(), u = r / K;
    return Need{u, K * (u > 0 ? limits.max : limits.min)};
}

/// For equations: the steady-state y with u at the limit that it would have to exceed.
std::optional<Need> of_setpoint(const VerdictInput& c, const NonlinearSystem& system, const ActuatorLimits& limits) {
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

std::optional<ActuatorLimits> limits_of(const VerdictInput& c) {
    const NonlinearSystem* system = c.context.subject.equations();
    return system != nullptr ? limited_as(*system, c.context.options).actuator : c.context.options.actuator;
}

/// The u that the steps of an evaluation need.
struct Needs {
    ActuatorLimits limits;
    Need load;
    std::optional<Need> setpoint;

    bool carries_load() const { return carries(limits, load.u); }
    bool carries_setpoint() const { return !setpoint || carries(limits, setpoint->u); }
};

std::optional<Needs> needs_of(const VerdictInput& c) {
    const auto limits = limits_of(c);
    const LinearPlant* plant = c.context.subject.linear();
    if (!limits || plant == nullptr || !c.has_integral() || !c.evaluation.robustness.stable ||
        std::holds_alternative<Npid>(c.evaluation.controller))
        return {};
    const EvaluateOptions& options = c.context.options;
    const NonlinearSystem* system = c.context.subject.equations();
    return Needs{
        *limits, of_load(*limits, options.load_step),
        system != nullptr ? of_setpoint(c, *system, *limits) : of_setpoint(*plant, *limits, options.setpoint_step)};
}

}  // namespace

StepsBeyondActuator steps_beyond_actuator(const VerdictInput& c) {
    const auto needs = needs_of(c);
    return needs ? StepsBeyondActuator{!needs->carries_setpoint(), !needs->carries_load()} : StepsBeyondActuator{};
}

bool stays_bounded(const LinearPlant& plant) { return plant.integrators() <= 0 && plant.unstable_poles() == 0; }

OptionalFinding actuator_too_small(const VerdictInput& c) {
    const auto needs = needs_of(c);
    if (!needs) return {};
    const auto& [limits, load, setpoint] = *needs;
    const bool load_fails = !needs->carries_load(), setpoint_fails = !needs->carries_setpoint();
    if (!load_fails && !setpoint_fails) return {};
    const EvaluateOptions& options = c.context.options;
    const Labels& labels = c.context.labels;
    const LinearPlant& plant = *c.context.subject.linear();
    const bool bounded = stays_bounded(plant);
    const bool asked = (setpoint_fails && c.context.given_steps.setpoint) || (load_fails && c.context.given_steps.load);
    FindingBuilder draft("actuator-too-small", !asked ? Level::note : bounded ? Level::warning : Level::bad);
    const bool upper = (setpoint_fails ? setpoint->u : load.u) > limits.max;
    draft.say(bounded ? "u stays at its limit of " : "y is unbounded, with u at its limit of ")
        .number("u_limit", upper ? limits.max : limits.min, printed_unit(labels.u))
        .say(": ");
    if (setpoint_fails)
        draft.say("it can follow a set-point step of ")
            .number("largest_setpoint_step", setpoint->carried, printed_unit(labels.y))
            .say(", not of ")
            .number("setpoint_step", options.setpoint_step, printed_unit(labels.y));
    if (load_fails)
        draft.say(setpoint_fails ? ", and can reject a load step of " : "it can reject a load step of ")
            .number("largest_load_step", load.carried, printed_unit(labels.u))
            .say(", not of ")
            .number("load_step", options.load_step, printed_unit(labels.u));
    return draft.say(asked ? ". No controller can change that."
                           : ". That size was assumed: give the steps that occur "
                             "in your loop.");
}

OptionalFinding at_its_limits(const VerdictInput& c) {
    if (!c.warned_of("actuator-limited")) return {};
    return FindingBuilder("at-limits", Level::warning)
        .say(
            "The controller output reaches its limit on these steps; Ms and the margins hold only between the limits.");
}

}  // namespace tunewright::verdict
