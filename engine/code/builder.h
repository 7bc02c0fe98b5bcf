// Builds the program of a controller, part by part in the order in which a call computes them.
#pragma once

#include "engine/code/composer.h"
#include "engine/code/plan.h"

namespace tunewright::code {

class Builder : Composer {
public:
    explicit Builder(const Plan& plan) : plan_(plan) {
        declare_settings();
        declare_states();
    }

    Program build() {
        add_gains();
        add_first_call();
        if (plan_.position) add_change_of_settings();
        add_signals();
        add_terms();
        add_bounds();
        add_output();
        add_memory();
        return take(notes(plan_));
    }

private:
    void declare_settings();
    void declare_fixed_settings();
    void declare_states();
    void declare_history();

    void add_gains();
    void add_first_call();
    void start_derivative(Block& start);
    void add_change_of_settings();
    void add_signals();
    void add_filter();
    void add_slope();
    void add_terms();
    void add_bounds();
    void add_output();
    Block held();
    Block position_output();
    Block velocity_output();
    void add_memory();

    Expr law_part(const Expr& r, const Expr& y) const { return gain_ * (b_ * r - y); }
    // The input of the integral in place of e.
    Expr fed(const Expr& e) const {
        return plan_.options.delta_r ? e * exponential(-(e * e) / (2 * delta_r_ * delta_r_)) : e;
    }

    const Plan plan_;
    Expr setpoint_ = input("setpoint", "r"), measurement_ = input("measurement", "y");
    Expr manual_ = optional_input("manual", "true: u is manual_output", Type::boolean);
    Expr manual_output_ = optional_input("manual_output", "the operator's u", Type::real);
    Expr u_ = output("u", "the controller's output");

    // Set by the declaring functions, if the plan needs them.
    Expr Kp_ = 0, Ti_ = 0, Td_ = 0, Ki_ = 0, Kd_ = 0, b_ = 0, direct_ = 0, u_min_ = 0, u_max_ = 0, rate_limit_ = 0;
    Expr Tr_ = 0, Tt_ = 0, bias_ = 0, y0_ = 0, at_rest_ = 0, restart_ = 0, Ts_ = 0, Tf_ = 0, c_ = 0, delta_r_ = 0;
    Expr started_ = 0, integral_ = 0, y_f_ = 0, filter_rate_ = 0, setpoint_last_ = 0, fed_last_ = 0, u_last_ = 0;
    Expr slope_ = 0, slope_last_ = 0, lead_last_ = 0, lead_2_ = 0, lead_3_ = 0, history_ = 0, place_ = 0;
    Expr gain_last_ = 0, gain_d_last_ = 0, b_last_ = 0, pd_last_ = 0;
    Expr gain_ = 0, gain_i_ = 0, gain_d_ = 0, error_ = 0, lead_ = 0, y_f_last_ = 0;
    Expr proportional_ = 0, derivative_ = 0, increment_ = 0, low_ = 0, high_ = 0;
};

}  // namespace tunewright::code
