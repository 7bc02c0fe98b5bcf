#include "engine/code/builder.h"

namespace tunewright::code {

void Builder::declare_settings() {
    const Settings& s = plan_.settings;
    Kp_ = setting("Kp", s.Kp, "proportional gain");
    if (s.ideal && plan_.integral) Ti_ = setting("Ti", s.Ti, "integral time in s; 0: no integral action");
    if (s.ideal && plan_.derivative) Td_ = setting("Td", s.Td, "derivative time in s");
    if (!s.ideal && plan_.integral) Ki_ = setting("Ki", s.Ki, "integral gain, a second");
    if (!s.ideal && plan_.derivative) Kd_ = setting("Kd", s.Kd, "derivative gain, times s");
    b_ = setting("b", plan_.pid.gains.b, "weight of the set point in the proportional part");
    direct_ = setting("direct", s.direct ? 1 : 0, "false: reverse, u falls when y rises", Type::boolean);
    u_min_ = setting("u_min", plan_.options.u_min.value_or(-kNoLimit), "least u");
    u_max_ = setting("u_max", plan_.options.u_max.value_or(kNoLimit), "largest u");
    rate_limit_ = setting("rate_limit", plan_.options.rate_limit, "most that u moves in a second; 0: any");
    if (plan_.tracks) {
        const double otherwise = tracking_time(plan_.pid.gains).value_or(plan_.pid.Ts);
        Tt_ = setting("Tt", plan_.options.tracking_time.value_or(otherwise), "tracking time of the anti-windup in s");
    }
    bias_ = setting("bias", plan_.options.bias, "u at the operating point");
    y0_ = setting("y0", plan_.options.y0, "y at the operating point");
    at_rest_ = setting("at_rest", 0, "true: the first call finds the loop at rest in y0 and bias", Type::boolean);
    restart_ = setting("restart", 0, "true: this call is the first one again", Type::boolean);
    declare_fixed_settings();
}

void Builder::declare_fixed_settings() {
    Ts_ = setting("Ts", plan_.pid.Ts, "sample time in s: the time from call to call");
    if (plan_.filters_setpoint())
        Tr_ = setting("Tr", plan_.pid.gains.setpoint_lag, "time constant of the set point's filter in s");
    if (plan_.smooths())
        Tf_ = setting("Tf", plan_.pid.gains.filter.Tf, "time constant of the measurement's filter in s");
    if (plan_.filters_slope())
        Tf_ = setting("Tf", plan_.pid.gains.filter.Tf, "time constant of the derivative's filter in s");
    if (plan_.derivative) c_ = setting("c", plan_.pid.gains.c, "weight of the set point in the derivative part");
    if (plan_.options.delta_r)
        delta_r_ = setting("delta_r", *plan_.options.delta_r, "error of which the integral sees 61 %");
}

void Builder::declare_states() {
    started_ = state("started", "false before the first call", Type::boolean);
    if (plan_.position)
        integral_ = state("integral", plan_.integral ? "the integral part, a term in u" : "what u is without error");
    y_f_ = state("y_f", plan_.smooths() ? "filtered measurement" : "measurement");
    if (plan_.smooths_twice()) filter_rate_ = state("filter_rate", "slope of y_f");
    setpoint_last_ = state("setpoint_last", plan_.filters_setpoint() ? "filtered set point of the last call"
                                                                     : "set point of the last call");
    if (plan_.keeps_error) fed_last_ = state("fed_last", "what the integral was last fed with");
    if (plan_.derivative) declare_history();
    u_last_ = state("u_last", "output of the last call");
    if (!plan_.position) return;
    gain_last_ = state("gain_last", "settings of the last call");
    if (plan_.derivative) gain_d_last_ = state("gain_d_last", "the same");
    b_last_ = state("b_last", "the same");
    pd_last_ = state("pd_last", "proportional and derivative part of the last call");
}

void Builder::declare_history() {
    slope_ = state("slope", "slope of c r - y_f, as the rule has it");
    if (!plan_.position) slope_last_ = state("slope_last", "slope that the last u contains; 0 in manual");
    if (plan_.rule == DerivativeRule::slope) {
        history_ = state("history", "c r - y_f of the last calls, in a ring", Type::real, plan_.pid.slope_samples);
        place_ = state("place", "the oldest of them", Type::integer);
        return;
    }
    lead_last_ = state("lead_last", "c r - y_f of the last call");
    if (plan_.rule != DerivativeRule::four_points) return;
    lead_2_ = state("lead_2", "c r - y_f two calls ago");
    lead_3_ = state("lead_3", "c r - y_f three calls ago");
}

}  // namespace tunewright::code
