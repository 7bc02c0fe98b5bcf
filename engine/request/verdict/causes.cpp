#include "engine/request/verdict/findings.h"

#include <cmath>
#include <numbers>

namespace tunewright::verdict {
namespace {

constexpr double kAsGood = 1.05;        // PI may cost so much more than PID and still be as good
constexpr double kExcessPercent = 10;   // over the optimum, worth a word
constexpr double kDeadTimeRules = 2;    // times the lags: L/(L + T) above 2/3
constexpr double kFilterDegrees = 20;   // of phase at the peak of |S|
constexpr double kNoisy = 20;           // Mks over |Kp|: beyond the usual derivative gains N of 2 to 20
constexpr double kNoiseOfRange = 0.02;  // standard deviation of u over the actuator's range

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

/// The phase that a filter of the measurement takes at omega, in degrees >= 0.
double filter_degrees(const Filter& filter, double omega) {
    const double x = omega * filter.Tf;
    if (filter.type == FilterType::measurement_first_order) return degrees(std::atan(x));
    if (filter.type == FilterType::measurement_second_order) return degrees(std::atan2(x, 1 - 0.5 * x * x));
    return 0;
}

}  // namespace

Found PI_or_PID(const Case& c) {
    const Figure& IAE = c.evaluation.performance.load.IAE;
    if (!c.entry.best_PI_load_IAE || !IAE || !(*IAE > 0)) return {};
    const double ratio = *c.entry.best_PI_load_IAE / *IAE;
    const bool as_good = ratio <= kAsGood;
    Draft draft(as_good ? "PI-as-good" : "derivative-pays", Level::note);
    draft.figure("ratio", ratio);
    if (as_good)
        return draft.say("PI does as well here: within the same limits its load IAE is ")
            .number("PI_load_IAE", *c.entry.best_PI_load_IAE)
            .say(" against ")
            .number("load_IAE", *IAE)
            .say(" of this PID.");
    return draft.say("Derivative action pays: without it the best load IAE within the same limits is ")
        .number("PI_load_IAE", *c.entry.best_PI_load_IAE)
        .say(" instead of ")
        .number("load_IAE", *IAE)
        .say(".");
}

Found excess(const Case& c) {
    if (!c.entry.optimum_at_Ms || !c.entry.optimum_at_Ms->excess_percent) return {};
    const double percent = *c.entry.optimum_at_Ms->excess_percent;
    if (percent < kExcessPercent) return {};
    return Draft("excess", Level::note)
        .say("At the same Ms the best PID has a lower load IAE: this one lies ")
        .number("excess_percent", percent, "%")
        .say(" above it.");
}

Found dead_time_rules(const Case& c) {
    const LinearPlant* plant = c.context.subject.linear();
    if (plant == nullptr || plant->integrators() != 0 || plant->unstable_poles() > 0) return {};
    const double L = plant->dead_time(), lags = plant->lag_sum();
    const bool alone = plant->poles().empty();
    if (!(L > 0) || (!alone && !(lags > 0 && L >= kDeadTimeRules * lags))) return {};
    Draft draft("dead-time-rules", Level::note);
    draft.say("Dead time rules this loop: ");
    if (!alone) draft.say("it is ").number("dead_time_over_lags", L / lags).say(" times the lags, and ");
    return draft.say("nothing acts sooner than ")
        .number("dead_time", L, printed_unit(c.context.labels.time))
        .say(" after a disturbance. A shorter dead time would help more than any tuning.");
}

Found filter_rules(const Case& c) {
    const LinearPlant* plant = c.context.subject.linear();
    const auto pid = to_ideal(c.evaluation.controller);
    const Robustness& r = c.evaluation.robustness;
    if (plant == nullptr || !pid || !r.omega_Ms || !(*r.omega_Ms > 0)) return {};
    const double taken = filter_degrees(pid->filter, *r.omega_Ms), by_plant = degrees(*r.omega_Ms * plant->dead_time());
    if (taken < kFilterDegrees || taken <= by_plant) return {};
    const Labels& labels = c.context.labels;
    return Draft("filter-rules", Level::note)
        .say("The measurement's filter (Tf ")
        .number("Tf", pid->filter.Tf, printed_unit(labels.time))
        .say(") rules this loop: at ")
        .number("omega_Ms", *r.omega_Ms, "rad/" + labels.time)
        .say(" it takes ")
        .number("filter_degrees", taken)
        .say("° of phase, the dead time ")
        .number("dead_time_degrees", by_plant)
        .say("°. A shorter filter would help more than any tuning.");
}

Found sample_time(const Case& c) {
    const auto& longest = c.entry.longest_sample_time;
    const double Ts = c.context.sample_time;
    if (!longest || !*longest || Ts <= **longest) return {};
    const std::string unit = printed_unit(c.context.labels.time);
    return Draft("sample-time", Level::warning)
        .say("A sample time of ")
        .number("sample_time", Ts, unit)
        .say(" costs margin or speed: at most ")
        .number("longest_sample_time", **longest, unit)
        .say(" keeps Ms within 5 % of the continuous loop's.")
        .figure("percent", 5);
}

Found noise(const Case& c) {
    const Robustness& r = c.evaluation.robustness;
    const double Kp = std::abs(gains(c.evaluation.controller).Kp);
    const Labels& labels = c.context.labels;
    if (!r.Mks && gains(c.evaluation.controller).Kd != 0)
        return Draft("no-filter", Level::warning)
            .say("The derivative has no filter: nothing bounds what noise does to the controller output. Give it one.");
    const auto& measured = c.evaluation.performance.noise;
    const auto& actuator = c.context.options.actuator;
    if (measured && measured->u_std && *measured->u_std > 0) {
        const double range = actuator ? actuator->max - actuator->min : INFINITY;
        return Draft("noise", *measured->u_std > kNoiseOfRange * range ? Level::warning : Level::note)
            .say("The noise moves the controller output by ")
            .number("u_std", *measured->u_std, printed_unit(labels.u))
            .say(" (standard deviation).");
    }
    if (!r.Mks || !(Kp > 0) || *r.Mks < kNoisy * Kp) return {};
    return Draft("noise-gain", Level::warning)
        .say("Noise reaches the controller output up to ")
        .number("ratio", *r.Mks / Kp)
        .say(" times as strong as by the proportional gain (Mks ")
        .number("Mks", *r.Mks, quotient_unit(labels.u, labels.y))
        .say("). If the output looks restless, raise Tf.");
}

}  // namespace tunewright::verdict
