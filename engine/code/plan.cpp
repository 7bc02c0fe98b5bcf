#include "engine/code/plan.h"

#include "engine/number_text.h"

namespace tunewright::code {
namespace {

std::string measurement_note(const Plan& plan) {
    if (plan.filter == FilterType::measurement_first_order)
        return "y_f is the measurement behind a filter of first order, 1/(1 + s Tf), by backward Euler.";
    if (plan.smooths_twice())
        return "y_f is the measurement behind a filter of second order, 1/(1 + s Tf + (s Tf)^2/2), by backward Euler.";
    return "y_f is the measurement itself.";
}

std::string integral_note(const Plan& plan) {
    if (!plan.integral) return "There is no integral action.";
    const std::string e = plan.options.delta_r ? "phi" : "e";
    std::string out = "I grows by ";
    switch (plan.pid.integral) {
        case IntegralRule::backward: out += "Ki Ts " + e + "[k] (backward rule)"; break;
        case IntegralRule::forward: out += "Ki Ts " + e + "[k-1] (forward rule)"; break;
        case IntegralRule::trapezoidal: out += "Ki Ts (" + e + "[k] + " + e + "[k-1])/2 (trapezoidal rule)"; break;
    }
    out += plan.settings.ideal ? ", Ki = Kp/Ti." : ".";
    if (plan.options.delta_r) out += " phi = e exp(-e^2/(2 delta_r^2)), which is small for a large error.";
    return out;
}

std::string derivative_note(const Plan& plan) {
    if (!plan.derivative) return "There is no derivative action.";
    std::string out = plan.settings.ideal ? "D is Kp Td times the slope of f = c r - y_f, "
                                          : "D is Kd times the slope of f = c r - y_f, ";
    switch (plan.rule) {
        case DerivativeRule::difference: return out + "(f[k] - f[k-1])/Ts.";
        case DerivativeRule::filtered_backward: return out + "behind a filter 1/(1 + s Tf) by the backward rule.";
        case DerivativeRule::filtered_forward: return out + "behind a filter 1/(1 + s Tf) by the forward rule.";
        case DerivativeRule::filtered_trapezoidal: return out + "behind a filter 1/(1 + s Tf) by the trapezoidal rule.";
        case DerivativeRule::slope:
            return out + "(f[k] - f[k-M])/(M Ts) with M = " + std::to_string(plan.pid.slope_samples) + ".";
        case DerivativeRule::four_points: return out + "(3 f[k] + f[k-1] - f[k-2] - 3 f[k-3])/(10 Ts).";
    }
    return out;
}

std::string law_note(const Plan& plan) {
    const std::string form =
        plan.position ? "Law: u = Kp (b r - y_f) + I + D, with the set point r and e = r - y_f. "
                      : "Law, in its velocity form: each call adds to the last u the increment of Kp (b r - y_f) + I + "
                        "D, with the set point r and e = r - y_f. ";
    const std::string set = plan.filters_setpoint()
                                ? "r is the set point behind a filter of first order, 1/(1 + s Tr), by backward Euler. "
                                : "";
    return form + set + measurement_note(plan) + " " + integral_note(plan) + " " + derivative_note(plan) +
           " Times are in seconds. The gains are positive; direct reverses the action.";
}

std::string limit_note(const Plan& plan) {
    std::string out =
        "Limits: u stays from u_min to u_max, and in automatic it moves by at most rate_limit in a second "
        "(0: no limit).";
    if (!plan.options.u_min || !plan.options.u_max)
        out += " Not both limits were given: set u_min and u_max to the ends of your actuator before you use it.";
    return out;
}

std::string windup_note(const Plan& plan) {
    if (!plan.position) return "Anti-windup: not needed. The next u starts from the limited one.";
    if (!plan.integral) return "Anti-windup: not needed without integral action.";
    if (plan.tracks)
        return "Anti-windup by back-calculation: while a limit holds u, the integral part moves by Ts/Tt of the "
               "difference between limited and unlimited u, at most by all of it. Tt is " +
               std::string(plan.options.tracking_time                  ? "as requested."
                           : !tracking_time(plan.pid.gains)            ? "one sample time."
                           : plan.derivative && plan.pid.gains.Kp != 0 ? "sqrt(Ti Td)."
                                                                       : "Ti.");
    return "Anti-windup by clamping: while a limit holds u, the integral part does not move further beyond it.";
}

std::string manual_note(const Plan& plan) {
    std::string out = "Manual: u is manual_output, limited by u_min and u_max but not by rate_limit. ";
    out +=
        !plan.position ? "Automatic continues from the last u, so that u does not jump."
        : plan.integral
            ? "The integral part follows, so that u does not jump at the switch to automatic."
            : "The level of u follows, so that u does not jump at the switch to automatic; it keeps that value until a "
              "restart.";
    if (plan.derivative)
        out +=
            " D is left out of it, because the noise of one call would stay in u; D acts from the first call in "
            "automatic on.";
    return out;
}

std::string change_note(const Plan& plan) {
    if (plan.follows_schedule)
        return "Changes: the limits may be changed between two calls, and u obeys them at once. Change Ts and c only "
               "with a restart, in manual at the present u; the schedule sets the others.";
    std::string names = plan.settings.ideal ? "Kp" : "Kp";
    if (plan.integral) names += plan.settings.ideal ? ", Ti" : ", Ki";
    if (plan.derivative) names += plan.settings.ideal ? ", Td" : ", Kd";
    std::string fixed = "Ts";
    if (plan.smooths() || plan.filters_slope()) fixed += ", Tf";
    if (plan.derivative) fixed += ", c";
    if (plan.options.delta_r) fixed += ", delta_r";
    return "Changes: " + names +
           " and b may be changed between two calls, and u does not jump. The limits may be changed too, and u obeys "
           "them at once. Change " +
           fixed + " only with a restart, in manual at the present u.";
}

std::string start_note(const Plan& plan) {
    std::string out = "First call: the states are set from the first measurement, so that u has no kick. ";
    out += plan.integral ? "u begins at manual_output in manual, at bias in automatic. "
                         : "u is bias + Kp (b (r - y0) - (y - y0)). ";
    return out +
           "With at_rest the loop is assumed to have been at rest at y = r = y0, u = bias until then: u is the law in "
           "deviations from y0 and bias.";
}

}  // namespace

std::vector<std::string> notes(const Plan& plan) {
    return {law_note(plan),    limit_note(plan),  windup_note(plan),
            manual_note(plan), change_note(plan), start_note(plan)};
}

}  // namespace tunewright::code
