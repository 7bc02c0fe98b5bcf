#include "engine/request/verdict/cures.h"
#include "engine/request/verdict/findings.h"
#include "engine/tuning/robust/robust.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tunewright::verdict {
namespace {

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

/// The phase lag of a measurement filter at omega, in degrees >= 0.
double filter_degrees(const Filter& filter, double omega) {
    const double x = omega * filter.Tf;
    if (filter.type == FilterType::measurement_first_order) return degrees(std::atan(x));
    if (filter.type == FilterType::measurement_second_order) return degrees(std::atan2(x, 1 - 0.5 * x * x));
    return 0;
}

std::string kind_of(const Certificate& proof) {
    const char* sign = proof.root.low[0] < 0 ? "" : " of positive gains";
    switch (proof.problem.structure) {
        case CertifiedStructure::pi: return std::string("PI") + sign;
        case CertifiedStructure::pid_fixed: return std::string("PID with this filter") + sign;
        case CertifiedStructure::pid_tied: return std::string("PID with Tf = Td/10") + sign;
    }
    return "PID";
}

}  // namespace

OptionalFinding PI_or_PID(const VerdictInput& c) {
    const Figure& IAE = c.evaluation.performance.load.IAE;
    if (!c.entry.best_PI_load_IAE || !IAE || !(*IAE > 0)) return {};
    const double ratio = *c.entry.best_PI_load_IAE / *IAE;
    const bool as_good = ratio <= kMaxCostRatioAsGood;
    FindingBuilder draft(as_good ? "PI-as-good" : "derivative-pays", Level::note);
    draft.figure("ratio", ratio);
    if (as_good)
        return draft.say("A PI is as good here: within the same limits its load IAE is ")
            .number("PI_load_IAE", *c.entry.best_PI_load_IAE)
            .say(" against ")
            .number("load_IAE", *IAE)
            .say(" of this PID.");
    return draft.say("Derivative action helps: without it the best load IAE within the same limits is ")
        .number("PI_load_IAE", *c.entry.best_PI_load_IAE)
        .say(" instead of ")
        .number("load_IAE", *IAE)
        .say(".");
}

OptionalFinding excess(const VerdictInput& c) {
    if (!c.entry.optimum_at_Ms || !c.entry.optimum_at_Ms->excess_percent) return {};
    const double percent = *c.entry.optimum_at_Ms->excess_percent;
    if (percent < kExcessPercent) return {};
    return FindingBuilder("excess", Level::note)
        .say("At the same Ms the best PID has a lower load IAE: this one lies ")
        .number("excess_percent", percent, "%")
        .say(" above it.");
}

OptionalFinding proved(const VerdictInput& c) {
    const auto* report = c.entry.report_as<CertificateReport>();
    if (report == nullptr) return {};
    const Certificate& proof = report->certificate;
    FindingBuilder draft(proof.complete ? "proved" : "proved-so-far", Level::note);
    draft.say(proof.complete ? "Within " : "So far proved to be within ")
        .say(figure_text(100 * std::max(0.0, proof.gap)))
        .say(" % of the best " + kind_of(proof) + " within these limits and the certificate's box of gains")
        .say(proof.complete ? " (proved)." : ".");
    return draft.figure("gap", proof.gap).figure("lower", proof.lower);
}

OptionalFinding dead_time_rules(const VerdictInput& c) {
    const LinearPlant* plant = c.context.subject.linear();
    if (plant == nullptr || plant->integrators() != 0 || plant->unstable_poles() > 0) return {};
    const double L = plant->dead_time();
    // The sum of the lags does not measure an oscillating plant: an undamped resonance has none.
    const double lags = std::max(plant->lag_sum(), plant->time_scale() - L);
    const bool alone = plant->poles().empty();
    if (!(L > 0) || (!alone && !(lags > 0 && L >= kMinDeadTimeOverLags * lags))) return {};
    FindingBuilder draft("dead-time-rules", Level::note);
    if (!alone) draft.say("The dead time is ").number("dead_time_over_lags", L / lags).say(" times the lags: nothing");
    draft.say(alone ? "Nothing acts sooner than " : " acts sooner than ")
        .number("dead_time", L, printed_unit(c.context.labels.time))
        .say(" after a disturbance");
    const Figure& IAE = c.performance().load.IAE;
    const auto min = min_load_IAE(c);
    if (min && IAE)
        draft.say(", and no controller has a load IAE below ")
            .number("least_load_IAE", *min)
            .say("; this one has ")
            .number("load_IAE", *IAE);
    return draft.say(".");
}

OptionalFinding filter_rules(const VerdictInput& c) {
    const LinearPlant* plant = c.context.subject.linear();
    const auto pid = to_ideal(c.evaluation.controller);
    const Robustness& r = c.evaluation.robustness;
    if (plant == nullptr || !pid || !r.omega_Ms || !(*r.omega_Ms > 0)) return {};
    const double taken = filter_degrees(pid->filter, *r.omega_Ms), by_plant = degrees(*r.omega_Ms * plant->dead_time());
    if (taken < kMinFilterPhaseDegrees || taken <= by_plant) return {};
    const Labels& labels = c.context.labels;
    FindingBuilder draft("filter-rules", Level::note);
    draft.say("The measurement's filter (Tf ")
        .number("Tf", pid->filter.Tf, printed_unit(labels.time))
        .say(") limits this loop: at ")
        .number("omega_Ms", *r.omega_Ms, "rad/" + labels.time)
        .say(" it takes ")
        .number("filter_degrees", taken)
        .say("° of phase, the dead time ")
        .number("dead_time_degrees", by_plant)
        .say("°.");
    const Figure& IAE = c.evaluation.performance.load.IAE;
    const auto shorter = designed_with_filter(c, 0.5 * pid->filter.Tf);
    if (!IAE || !shorter || !shorter->load_IAE || !(kMaxCostRatioAsGood * *shorter->load_IAE < *IAE)) return draft;
    return draft.say(" With half of it (")
        .number("shorter_Tf", 0.5 * pid->filter.Tf, printed_unit(labels.time))
        .say(") the design within the same limits has a load IAE of ")
        .number("shorter_load_IAE", *shorter->load_IAE)
        .say(" instead of ")
        .number("load_IAE", *IAE)
        .say(" and a noise gain Mks of ")
        .number("shorter_Mks", shorter->Mks, quotient_unit(labels.u, labels.y))
        .say(" instead of ")
        .number("Mks", *r.Mks, quotient_unit(labels.u, labels.y))
        .say(".");
}

OptionalFinding sample_time(const VerdictInput& c) {
    const auto& longest = c.entry.longest_sample_time;
    const double Ts = c.context.sample_time;
    if (!longest || !*longest || Ts <= **longest) return {};
    const std::string unit = printed_unit(c.context.labels.time);
    return FindingBuilder("sample-time", Level::warning)
        .say("A sample time of ")
        .number("sample_time", Ts, unit)
        .say(" reduces the margin or the speed: a sample time of at most ")
        .number("longest_sample_time", **longest, unit)
        .say(" keeps Ms within 5 % of the continuous loop's.")
        .figure("percent", 5);
}

namespace {

/// Reports Mks with a filter and the same gains, if the filter leaves the loop its margins.
void say_filtered(FindingBuilder& draft, const VerdictInput& c, const Filter& filter) {
    const auto peaks = peaks_with_filter(c, filter);
    const Figure& Ms = c.evaluation.robustness.Ms;
    if (!peaks || !Ms || peaks->Ms > std::max(*Ms, kLittleMarginMs)) return;
    const Labels& labels = c.context.labels;
    draft.say(" With Tf = ")
        .number("longer_Tf", filter.Tf, printed_unit(labels.time))
        .say(" and the same gains Mks is ")
        .number("filtered_Mks", peaks->Mks, quotient_unit(labels.u, labels.y))
        .say(" and Ms ")
        .number("filtered_Ms", peaks->Ms)
        .say(".");
}

Finding no_filter(const VerdictInput& c) {
    FindingBuilder draft("no-filter", Level::warning);
    draft.say("The derivative has no filter: the effect of measurement noise on the controller output is unbounded.");
    const auto pid = to_ideal(c.evaluation.controller);
    if (pid) say_filtered(draft, c, {FilterType::derivative, std::abs(pid->Td) / kUsualN});
    return draft;
}

}  // namespace

OptionalFinding noise(const VerdictInput& c) {
    const Robustness& r = c.evaluation.robustness;
    const double Kp = std::abs(gains(c.evaluation.controller).Kp);
    const Labels& labels = c.context.labels;
    if (!r.Mks && gains(c.evaluation.controller).Kd != 0) return no_filter(c);
    const auto& measured = c.evaluation.performance.noise;
    const auto& actuator = c.context.options.actuator;
    if (measured && measured->u_std && *measured->u_std > 0) {
        const double range = actuator ? actuator->max - actuator->min : INFINITY;
        return FindingBuilder("noise", *measured->u_std > kMinNoiseOverRange * range ? Level::warning : Level::note)
            .say("The noise moves the controller output by ")
            .number("u_std", *measured->u_std, printed_unit(labels.u))
            .say(" (standard deviation).");
    }
    if (!r.Mks || !(Kp > 0) || *r.Mks < kMinNoisyMksOverKp * Kp || !noise_gain_peaks_beyond(c)) return {};
    FindingBuilder draft("noise-gain", Level::warning);
    draft.say("The controller amplifies measurement noise up to ")
        .number("ratio", *r.Mks / Kp)
        .say(" times as much as its proportional gain does (Mks ")
        .number("Mks", *r.Mks, quotient_unit(labels.u, labels.y))
        .say(").");
    if (const auto pid = to_ideal(c.evaluation.controller); pid && pid->filter.type != FilterType::none)
        say_filtered(draft, c, {pid->filter.type, 2 * pid->filter.Tf});
    return draft;
}

}  // namespace tunewright::verdict
