#include "engine/controller/sampled/pid_program.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace tunewright {
namespace {

std::size_t samples_kept(const SampledPid& law) {
    if (law.derivative == DerivativeRule::slope) return static_cast<std::size_t>(law.slope_samples);
    return law.derivative == DerivativeRule::four_points ? 3 : 1;
}

double rounded(double value, double resolution) {
    return resolution > 0 ? resolution * std::round(value / resolution) : value;
}

}  // namespace

PidProgram::PidProgram(const SampledPid& law, const ProgramLimits& limits)
    : law_(law), limits_(limits), past_(samples_kept(law), 0.0) {}

void PidProgram::take_over(double r, double y, double u) {
    r_f_ = r;
    y_f_ = y_before_ = y;
    v_ = D_ = 0;
    set_before_ = law_.gains.c * r;
    std::fill(past_.begin(), past_.end(), law_.gains.c * r - y);
    P_ = law_.gains.Kp * (law_.gains.b * r - y);
    I_ = u - P_;
    e_ = r - y;
    u_ = u;
}

// Computes y_f and v = dy_f/dt: v = (y - y_f)/Tf for the first order, v' = (2/Tf^2)(y - y_f) - (2/Tf) v for the second.
double PidProgram::filtered_trapezoidal(double y) {
    const double Tf = law_.gains.filter.Tf, r = 0.5 * law_.Ts / Tf, mean = 0.5 * (y + y_before_), before = y_f_;
    y_before_ = y;
    if (law_.gains.filter.type == FilterType::measurement_first_order) {
        y_f_ = ((1 - r) * before + 2 * r * mean) / (1 + r);
        v_ = (y - y_f_) / Tf;
    } else {
        const double a = 2 * r + 2 * r * r, v = v_;
        v_ = ((1 - a) * v + 8 * r * r / law_.Ts * (mean - before)) / (1 + a);
        y_f_ = before + 0.5 * law_.Ts * (v + v_);
    }
    return y_f_;
}

double PidProgram::filtered(double y) {
    if (whole_by_trapezoids(law_)) return filtered_trapezoidal(y);
    const double Ts = law_.Ts, Tf = law_.gains.filter.Tf;
    switch (law_.gains.filter.type) {
        case FilterType::measurement_first_order: y_f_ = (Tf * y_f_ + Ts * y) / (Tf + Ts); return y_f_;
        case FilterType::measurement_second_order: {
            const double ratio = Ts / Tf;
            v_ = (v_ + 2 * ratio / Tf * (y - y_f_)) / (1 + 2 * ratio + 2 * ratio * ratio);
            y_f_ += Ts * v_;
            return y_f_;
        }
        default: return y;
    }
}

double PidProgram::derivative(double f) {
    const double Ts = law_.Ts, Kd = law_.gains.Kd;
    const bool has_filter = law_.gains.filter.type == FilterType::derivative;
    const double Tf = has_filter ? law_.gains.filter.Tf : 0, move = Kd * (f - past_[0]);
    switch (law_.derivative) {
        case DerivativeRule::difference: D_ = move / Ts; break;
        case DerivativeRule::filtered_backward: D_ = (Tf * D_ + move) / (Tf + Ts); break;
        case DerivativeRule::filtered_forward: D_ = has_filter ? (1 - Ts / Tf) * D_ + move / Tf : move / Ts; break;
        case DerivativeRule::filtered_trapezoidal:
            if (whole_by_trapezoids(law_)) {
                const double set = f + y_f_;  // c r is not filtered
                D_ = Kd * ((set - set_before_) / Ts - v_);
                set_before_ = set;
                break;
            }
            D_ = has_filter ? ((2 * Tf - Ts) * D_ + 2 * move) / (2 * Tf + Ts) : move / Ts;
            break;
        case DerivativeRule::slope: D_ = Kd * (f - past_.back()) / (law_.slope_samples * Ts); break;
        case DerivativeRule::four_points: D_ = Kd * (3 * (f - past_[2]) + past_[0] - past_[1]) / (10 * Ts); break;
    }
    std::rotate(past_.begin(), past_.end() - 1, past_.end());
    past_[0] = f;
    return D_;
}

double PidProgram::integral_increment(double e) const {
    const double h = law_.gains.Ki * law_.Ts;
    switch (law_.integral) {
        case IntegralRule::backward: return h * e;
        case IntegralRule::forward: return h * e_;
        case IntegralRule::trapezoidal: return 0.5 * h * (e + e_);
    }
    return 0;
}

double PidProgram::step(double r, double y) {
    if (const double T = law_.gains.setpoint_lag; T > 0) r = r_f_ = (T * r_f_ + law_.Ts * r) / (T + law_.Ts);
    y = rounded(y, limits_.y_resolution);
    if (std::abs(r - y) < limits_.dead_band) y = r;
    const double y_f = filtered(y), e = r - y_f, D_before = D_;
    const double P = law_.gains.Kp * (law_.gains.b * r - y_f), D = derivative(law_.gains.c * r - y_f);
    const double increment = integral_increment(e);
    const auto within = [&](double u) {
        return limits_.output ? std::clamp(u, limits_.output->min, limits_.output->max) : u;
    };
    const double u = law_.velocity ? u_ + (P - P_) + increment + (D - D_before) : P + I_ + increment + D;
    const bool drives_further = u != within(u) && (u > within(u)) == (increment > 0);
    if (!drives_further) I_ += increment;
    u_ = within(u);
    P_ = P;
    e_ = e;
    const double given = rounded(u_, limits_.u_resolution), beyond = given - within(given);
    return beyond == 0 ? given
                       : given - std::copysign(limits_.u_resolution, beyond);  // the last multiple within the limits
}

}  // namespace tunewright
