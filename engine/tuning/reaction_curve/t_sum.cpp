#include "engine/tuning/reaction_curve/t_sum.h"

#include "engine/number_text.h"

namespace tunewright {
namespace {

using enum ControllerKind;

constexpr double kDeadTimeDominated = 0.5;  // L/T_sum above which the fast settings have too little margin

IdealPid settings(ControllerKind controller, TSumSpeed speed, double K, double T_sum) {
    const bool fast = speed == TSumSpeed::fast;
    if (controller == P) return {.Kp = 1 / K};
    if (controller == PI) return {.Kp = (fast ? 1 : 0.5) / K, .Ti = (fast ? 0.7 : 0.5) * T_sum};
    return {.Kp = (fast ? 2 : 1) / K, .Ti = (fast ? 0.8 : 0.66) * T_sum, .Td = (fast ? 0.194 : 0.167) * T_sum};
}

std::optional<Error> unfit(const LinearPlant& plant, double T_sum, const TSumOptions& options) {
    const bool fast = options.speed == TSumSpeed::fast;
    if (fast && options.controller == P)
        return Error{ErrorKind::invalid_argument, "speed",
                     "The rule has no fast settings for a P controller. Choose PI or PID, or omit speed."};
    if (plant.integrators() != 0 || plant.unstable_poles() > 0)
        return degenerate("plant", "The T-sum rule is for stable plants with a static gain that is not 0.",
                          "Use simc, lambda or robust.");
    if (T_sum <= 0)
        return degenerate("plant",
                          "The sum of the plant's lags and dead time minus its leads is " + text(T_sum) +
                              ", but the rule scales all times by that sum.",
                          "Use robust.");
    return std::nullopt;
}

std::vector<Warning> remarks(const LinearPlant& plant, double T_sum, const TSumOptions& options) {
    if (options.speed != TSumSpeed::fast || plant.dead_time() <= kDeadTimeDominated * T_sum) return {};
    return {outside_validity("L/T_sum is " + text(plant.dead_time() / T_sum) +
                             ", above 0.5: with so much dead time the fast settings are oscillatory or unstable. Use "
                             "the normal ones, or robust.")};
}

Expected<TunedController> tune_t_sum(const TuningProblem& problem, const TSumOptions& options) {
    const LinearPlant& plant = problem.linear;
    const double T_sum = plant.lag_sum() + plant.dead_time();
    if (const auto error = unfit(plant, T_sum, options)) return *error;
    IdealPid answer = settings(options.controller, options.speed, plant.low_frequency_gain(), T_sum);
    answer.filter = chosen_filter(options.filter, FilterType::derivative, answer.Td);
    return rule_answer(answer, remarks(plant, T_sum, options));
}

}  // namespace

TuningMethod t_sum_method() {
    TuningMethod method;
    method.id = "t_sum";
    method.title = "T-sum rule (Kuhn)";
    method.formula =
        "T_sum = sum T_lag - sum T_lead + L; normal: P: Kp = 1/K; PI: Kp = 0.5/K, Ti = 0.5 T_sum; PID: Kp = 1/K, Ti = "
        "0.66 "
        "T_sum, "
        "Td = 0.167 T_sum; fast: PI: Kp = 1/K, Ti = 0.7 T_sum; PID: Kp = 2/K, Ti = 0.8 T_sum, Td = 0.194 T_sum";
    method.source = "Kuhn, Automatisierungstechnische Praxis 37 (1995) 10-16";
    method.needs = "any stable linear plant with a static gain";
    method.validity = "step responses of S shape without much overshoot; fast: little dead time";
    OptionSet<TSumOptions> options;
    add_controller(options, {P, PI, PID});
    options.choice(&TSumOptions::speed, "speed", "normal; fast: twice the gain, for plants with little dead time.",
                   Words<TSumSpeed>{{"normal", TSumSpeed::normal}, {"fast", TSumSpeed::fast}});
    add_filter(options, "of the derivative part, Td s/(1 + s Tf); the source has none.");
    method.variants = {{"PI", options.given_for({.controller = PI})}, {"PID", {}}};
    method.bind(options, tune_t_sum);
    return method;
}

}  // namespace tunewright
