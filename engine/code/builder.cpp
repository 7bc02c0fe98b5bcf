#include "engine/code/builder.h"

namespace tunewright::code {

void Builder::add_gains() {
    const bool ideal = plan_.settings.ideal;
    add(remark("The gains with the sign of the action."));
    gain_ = let("gain", "Kp with the sign of the action", Kp_);
    add(when(direct_, {assign(gain_, -Kp_)}));
    if (plan_.integral) {
        gain_i_ = let("gain_i", "integral gain", ideal ? Expr(0.0) : Ki_);
        add(ideal ? when(Ti_ > 0, {assign(gain_i_, gain_ / Ti_)}) : when(direct_, {assign(gain_i_, -Ki_)}));
    }
    if (!plan_.derivative) return;
    gain_d_ = let("gain_d", "derivative gain", ideal ? gain_ * Td_ : Kd_);
    if (!ideal) add(when(direct_, {assign(gain_d_, -Kd_)}));
}

void Builder::add_first_call() {
    add(remark("The first call: the states are those of a loop at rest."));
    add(when(restart_, {assign(started_, truth(false))}));
    Block start{assign(setpoint_last_, setpoint_), assign(y_f_, measurement_),
                when(at_rest_, {assign(setpoint_last_, y0_), assign(y_f_, y0_)})};
    if (plan_.smooths_twice()) start.push_back(assign(filter_rate_, 0.0));
    if (plan_.keeps_error) {
        if (plan_.options.delta_r) {
            error_ = local("error", "r - y_f");
            start.push_back(assign(error_, setpoint_last_ - y_f_));
            start.push_back(assign(fed_last_, fed(error_)));
        } else {
            start.push_back(assign(fed_last_, setpoint_last_ - y_f_));
        }
    }
    if (plan_.derivative) start_derivative(start);
    start.push_back(assign(u_last_, bias_));
    if (plan_.position) {
        start.push_back(assign(integral_, bias_ - law_part(y0_, y0_)));
        start.push_back(assign(gain_last_, gain_));
        if (plan_.derivative) start.push_back(assign(gain_d_last_, gain_d_));
        start.push_back(assign(b_last_, b_));
    }
    add(when(inverse(started_), std::move(start)));
}

void Builder::start_derivative(Block& start) {
    start.push_back(assign(slope_, 0.0));
    if (!plan_.position) start.push_back(assign(slope_last_, 0.0));
    const Expr lead = c_ * setpoint_last_ - y_f_;
    if (plan_.rule == DerivativeRule::slope) {
        const Expr k = local("k", "counts", Type::integer);
        start.push_back(repeat(k, plan_.pid.slope_samples, {assign(element(history_, k), lead)}));
        start.push_back(assign(place_, whole(0)));
        return;
    }
    start.push_back(assign(lead_last_, lead));
    if (plan_.rule != DerivativeRule::four_points) return;
    start.push_back(assign(lead_2_, lead_last_));
    start.push_back(assign(lead_3_, lead_last_));
}

void Builder::add_change_of_settings() {
    Expr changed = either(gain_ != gain_last_, b_ != b_last_), sum = law_part(setpoint_last_, y_f_);
    if (plan_.derivative) {
        changed = either(changed, gain_d_ != gain_d_last_);
        sum = sum + gain_d_ * slope_;
    }
    const Expr pd_now = local("pd_now", "pd_last with the new settings");
    add(
        remark("Settings have changed: the integral part changes by as much as the other parts of the last u, in the "
               "other direction."));
    add(when(changed, {assign(pd_now, sum), assign(integral_, integral_ + pd_last_ - pd_now)}));
}

void Builder::add_signals() {
    if (plan_.filters_setpoint()) {
        add(remark("The set point's filter: the rest uses its output."));
        setpoint_ = let("setpoint_f", "filtered set point", (Tr_ * setpoint_last_ + Ts_ * setpoint_) / (Tr_ + Ts_));
    }
    add(remark(plan_.smooths() ? "The measurement's filter, and the error." : "The error."));
    if (!plan_.position) y_f_last_ = let("y_f_last", "y_f of the last call", y_f_);
    add_filter();
    if (plan_.integral) {
        if (!(plan_.keeps_error && plan_.options.delta_r)) error_ = local("error", "r - y_f");
        add(assign(error_, setpoint_ - y_f_));
    }
    if (plan_.derivative) add_slope();
}

void Builder::add_filter() {
    if (plan_.filter == FilterType::measurement_first_order) {
        add(assign(y_f_, (Tf_ * y_f_ + Ts_ * measurement_) / (Tf_ + Ts_)));
    } else if (plan_.smooths_twice()) {
        const Expr ratio = let("ratio", "Ts/Tf", Ts_ / Tf_),
                   divisor = let("divisor", "of the filter", 1 + 2 * ratio + 2 * ratio * ratio);
        add(assign(filter_rate_, (filter_rate_ + 2 * ratio / Tf_ * (measurement_ - y_f_)) / divisor));
        add(assign(y_f_, y_f_ + Ts_ * filter_rate_));
    } else {
        add(assign(y_f_, measurement_));
    }
}

void Builder::add_slope() {
    add(remark("The input of the derivative, and its slope."));
    lead_ = let("lead", "c r - y_f", c_ * setpoint_ - y_f_);
    const auto step = [&] { return lead_ - lead_last_; };
    switch (plan_.rule) {
        case DerivativeRule::difference: add(assign(slope_, step() / Ts_)); break;
        case DerivativeRule::filtered_backward: add(assign(slope_, (Tf_ * slope_ + step()) / (Tf_ + Ts_))); break;
        case DerivativeRule::filtered_forward: add(assign(slope_, (1 - Ts_ / Tf_) * slope_ + step() / Tf_)); break;
        case DerivativeRule::filtered_trapezoidal:
            add(assign(slope_, ((2 * Tf_ - Ts_) * slope_ + 2 * step()) / (2 * Tf_ + Ts_)));
            break;
        case DerivativeRule::slope: {
            const int samples = plan_.pid.slope_samples;
            const Expr oldest = element(history_, place_);
            add(assign(slope_, (lead_ - oldest) / (static_cast<double>(samples) * Ts_)));
            add(assign(oldest, lead_));
            add(assign(place_, place_ + whole(1)));
            add(when(place_ >= whole(samples), {assign(place_, whole(0))}));
            return;
        }
        case DerivativeRule::four_points:
            add(assign(slope_, (3 * lead_ + lead_last_ - lead_2_ - 3 * lead_3_) / (10 * Ts_)));
            add(assign(lead_3_, lead_2_));
            add(assign(lead_2_, lead_last_));
            break;
    }
    add(assign(lead_last_, lead_));
}

void Builder::add_terms() {
    const bool position = plan_.position;
    add(remark(position ? "The parts of u." : "The increments of the parts of u."));
    proportional_ = let("proportional", position ? "proportional part" : "increment of the proportional part",
                        position ? law_part(setpoint_, y_f_) : law_part(setpoint_ - setpoint_last_, y_f_ - y_f_last_));
    if (plan_.derivative)
        derivative_ = let("derivative", position ? "derivative part" : "increment of the derivative part",
                          gain_d_ * (position ? slope_ : slope_ - slope_last_));
    if (!plan_.integral) return;
    increment_ = local("increment", "increment of the integral part");
    Expr share = error_;
    if (plan_.options.delta_r) {
        share = local("fed", "input of the integral");
        add(assign(share, fed(error_)));
    }
    switch (plan_.pid.integral) {
        case IntegralRule::backward: add(assign(increment_, gain_i_ * Ts_ * share)); break;
        case IntegralRule::forward: add(assign(increment_, gain_i_ * Ts_ * fed_last_)); break;
        case IntegralRule::trapezoidal: add(assign(increment_, gain_i_ * Ts_ * (share + fed_last_) / 2)); break;
    }
    if (plan_.keeps_error) add(assign(fed_last_, share));
}

void Builder::add_bounds() {
    add(remark("The range of u in this call."));
    low_ = let("low", "smallest u of this call", u_min_);
    high_ = let("high", "largest u of this call", u_max_);
    Block rate{assign(low_, u_last_ - rate_limit_ * Ts_), assign(high_, u_last_ + rate_limit_ * Ts_)};
    keep_within(rate, low_, u_min_, u_max_);
    keep_within(rate, high_, u_min_, u_max_);
    add(when(rate_limit_ > 0, std::move(rate)));
}

// Without integral action the level of u is that of the operating point, so that the first call obeys the law at once.
void Builder::add_output() {
    const Expr first = both(inverse(started_), inverse(at_rest_));
    add(remark(plan_.integral
                   ? "In manual, and in a first call that is not at rest, u is given and the states follow it."
                   : "In manual u is given, and the level from which automatic goes on follows it."));
    add(when(plan_.integral ? either(manual_, first) : manual_, held(),
             plan_.position ? position_output() : velocity_output()));
}

Block Builder::held() {
    Block block{assign(u_, plan_.integral ? bias_ : manual_output_)};
    if (plan_.integral) block.push_back(when(manual_, {assign(u_, manual_output_)}));
    keep_within(block, u_, u_min_, u_max_);
    // The derivative part is left out: at rest it consists only of the noise of one sample, and nothing would remove
    // that later.
    if (plan_.position) block.push_back(assign(integral_, u_ - proportional_));
    if (!plan_.position && plan_.derivative) block.push_back(assign(slope_last_, 0.0));
    return block;
}

Block Builder::position_output() {
    const auto sum = [&](const Expr& integral) {
        return plan_.derivative ? proportional_ + integral + derivative_ : proportional_ + integral;
    };
    Block block;
    if (!plan_.integral) {
        block.push_back(assign(u_, sum(integral_)));
        keep_within(block, u_, low_, high_);
        return block;
    }
    const Expr raw = local("raw", "u of the law alone");
    if (!plan_.tracks) {
        const Expr wound = local("wound", "true: the integral part would move further beyond the limit", Type::boolean);
        block.push_back(assign(raw, sum(integral_ + increment_)));
        block.push_back(assign(wound, either(both(raw > high_, increment_ > 0), both(raw < low_, increment_ < 0))));
        block.push_back(when(inverse(wound), {assign(integral_, integral_ + increment_)}));
        block.push_back(assign(u_, sum(integral_)));
        keep_within(block, u_, low_, high_);
        return block;
    }
    const Expr tracking = local("tracking", "share of the missing u by which the integral part moves");
    block.push_back(assign(integral_, integral_ + increment_));
    block.push_back(assign(raw, sum(integral_)));
    block.push_back(assign(u_, raw));
    keep_within(block, u_, low_, high_);
    block.push_back(assign(tracking, 1.0));
    block.push_back(when(Tt_ > Ts_, {assign(tracking, Ts_ / Tt_)}));
    block.push_back(when(gain_i_ != 0, {assign(integral_, integral_ + tracking * (u_ - raw))}));
    return block;
}

Block Builder::velocity_output() {
    const Expr sum = u_last_ + proportional_ + increment_;
    Block block{assign(u_, plan_.derivative ? sum + derivative_ : sum)};
    keep_within(block, u_, low_, high_);
    if (plan_.derivative) block.push_back(assign(slope_last_, slope_));
    return block;
}

void Builder::add_memory() {
    add(remark("For the next call."));
    add(assign(setpoint_last_, setpoint_));
    add(assign(u_last_, u_));
    if (plan_.position) {
        add(assign(gain_last_, gain_));
        if (plan_.derivative) add(assign(gain_d_last_, gain_d_));
        add(assign(b_last_, b_));
        add(assign(pd_last_, plan_.derivative ? proportional_ + derivative_ : proportional_));
    }
    add(assign(started_, truth(true)));
}

void Builder::declare_settings() {
    const Settings& s = plan_.settings;
    Kp_ = setting("Kp", s.Kp, "proportional gain");
    if (s.ideal && plan_.integral) Ti_ = setting("Ti", s.Ti, "integral time in s; 0: no integral action");
    if (s.ideal && plan_.derivative) Td_ = setting("Td", s.Td, "derivative time in s");
    if (!s.ideal && plan_.integral) Ki_ = setting("Ki", s.Ki, "integral gain, per second");
    if (!s.ideal && plan_.derivative) Kd_ = setting("Kd", s.Kd, "derivative gain, in s");
    b_ = setting("b", plan_.pid.gains.b, "weight of the set point in the proportional part");
    direct_ = setting("direct", s.direct ? 1 : 0, "false: reverse, u falls when y rises", Type::boolean);
    u_min_ = setting("u_min", plan_.options.u_min.value_or(-kNoLimit), "least u");
    u_max_ = setting("u_max", plan_.options.u_max.value_or(kNoLimit), "largest u");
    rate_limit_ = setting("rate_limit", plan_.options.rate_limit, "largest change of u per second; 0: no limit");
    if (plan_.tracks) {
        const double otherwise = tracking_time(plan_.pid.gains).value_or(plan_.pid.Ts);
        Tt_ = setting("Tt", plan_.options.tracking_time.value_or(otherwise), "tracking time of the anti-windup in s");
    }
    bias_ = setting("bias", plan_.options.bias, "u at the operating point");
    y0_ = setting("y0", plan_.options.y0, "y at the operating point");
    at_rest_ = setting("at_rest", 0, "true: in the first call the loop is at rest at y0 and bias", Type::boolean);
    restart_ = setting("restart", 0, "true: this call starts again as the first one", Type::boolean);
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
        delta_r_ = setting("delta_r", *plan_.options.delta_r, "error at which the integral acts on 61 % of it");
}

void Builder::declare_states() {
    started_ = state("started", "false before the first call", Type::boolean);
    if (plan_.position)
        integral_ = state("integral", plan_.integral ? "the integral part, a term in u" : "u without error");
    y_f_ = state("y_f", plan_.smooths() ? "filtered measurement" : "measurement");
    if (plan_.smooths_twice()) filter_rate_ = state("filter_rate", "slope of y_f");
    setpoint_last_ = state("setpoint_last", plan_.filters_setpoint() ? "filtered set point of the last call"
                                                                     : "set point of the last call");
    if (plan_.keeps_error) fed_last_ = state("fed_last", "last input of the integral");
    if (plan_.derivative) declare_history();
    u_last_ = state("u_last", "output of the last call");
    if (!plan_.position) return;
    gain_last_ = state("gain_last", "settings of the last call");
    if (plan_.derivative) gain_d_last_ = state("gain_d_last", "the same");
    b_last_ = state("b_last", "the same");
    pd_last_ = state("pd_last", "proportional and derivative part of the last call");
}

void Builder::declare_history() {
    slope_ = state("slope", "slope of c r - y_f, by the rule");
    if (!plan_.position) slope_last_ = state("slope_last", "slope in the last u; 0 in manual");
    if (plan_.rule == DerivativeRule::slope) {
        history_ = state("history", "c r - y_f of the last calls, in a ring", Type::real, plan_.pid.slope_samples);
        place_ = state("place", "index of the oldest value in the ring", Type::integer);
        return;
    }
    lead_last_ = state("lead_last", "c r - y_f of the last call");
    if (plan_.rule != DerivativeRule::four_points) return;
    lead_2_ = state("lead_2", "c r - y_f two calls ago");
    lead_3_ = state("lead_3", "c r - y_f three calls ago");
}

}  // namespace tunewright::code
