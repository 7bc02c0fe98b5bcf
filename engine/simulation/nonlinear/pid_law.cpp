#include "engine/simulation/nonlinear/pid_law.h"

namespace tunewright {

PidLaw::PidLaw(const ParallelPid& gains, double r, std::optional<double> delta_r, double tracking_rate)
    : gains_(gains), r_(r), tracking_rate_(tracking_rate) {
    if (delta_r) scaling_ = ErrorScaling{*delta_r};
    const double Kp = gains.Kp, Kd = gains.Kd, Tf = gains.filter.Tf;
    switch (gains.filter.type) {
        case FilterType::none: by_y_ = -Kp; break;
        case FilterType::derivative:
            order_ = 2;
            by_y_ = -Kp - Kd / Tf;
            by_state_[1] = -Kd / Tf;
            break;
        case FilterType::measurement_first_order:
            order_ = 2;
            by_y_ = -Kd / Tf;
            by_state_[1] = -Kp + Kd / Tf;
            break;
        case FilterType::measurement_second_order:
            order_ = 3;
            by_state_[1] = -Kp;
            by_state_[2] = -Kd / Tf;
            break;
    }
    if (!filters_setpoint()) return;
    by_state_[order_++] = Kp * gains.b + (gains.filter.type == FilterType::derivative ? Kd / Tf * gains.c : 0);
}

void PidLaw::rest(double y, std::span<double> s) const {
    s[0] = 0;
    for (double& state : s.first(std::size_t(order_))) state = 0;
    if (gains_.filter.type != FilterType::none) s[1] = gains_.filter.type == FilterType::derivative ? -y : y;
}

double PidLaw::command(double y, double y_slope, std::span<const double> s) const {
    double command = by_y_ * y + s[0];
    for (int i = 1; i < order_; ++i) command += by_state_[i] * s[std::size_t(i)];
    if (!filters_setpoint()) {
        command += gains_.Kp * gains_.b * r_;
        if (gains_.filter.type == FilterType::derivative) command += gains_.Kd / gains_.filter.Tf * gains_.c * r_;
    }
    if (pure_derivative()) command -= gains_.Kd * y_slope;
    return command;
}

void PidLaw::rates(double y, std::span<const double> s, double excess, std::span<double> ds) const {
    const double Tf = gains_.filter.Tf, r = seen(s);
    double y_f = y;
    switch (gains_.filter.type) {
        case FilterType::none: break;
        case FilterType::derivative: ds[1] = (gains_.c * r - y - s[1]) / Tf; break;
        case FilterType::measurement_first_order:
            y_f = s[1];
            ds[1] = (y - y_f) / Tf;
            break;
        case FilterType::measurement_second_order:
            y_f = s[1];
            ds[1] = s[2] / Tf;
            ds[2] = 2 * (y - y_f - s[2]) / Tf;
            break;
    }
    if (filters_setpoint()) ds[std::size_t(order_ - 1)] = (r_ - r) / gains_.setpoint_lag;
    const double e = r - y_f;
    ds[0] = gains_.Ki * (scaling_ ? e + scaling_->excess(e) : e) + tracking_rate_ * excess;
}

double PidLaw::rate_by_y(int i, double y) const {
    const double Tf = gains_.filter.Tf;
    if (filters_setpoint() && i == order_ - 1) return 0;
    switch (gains_.filter.type) {
        case FilterType::none: break;
        case FilterType::derivative:
            if (i == 1) return -1 / Tf;
            break;
        case FilterType::measurement_first_order: return i == 1 ? 1 / Tf : 0;
        case FilterType::measurement_second_order: return i == 2 ? 2 / Tf : 0;
    }
    return -gains_.Ki * (scaling_ ? 1 + scaling_->excess_slope(r_ - y) : 1);
}

double PidLaw::rate_by_state(int i, int j) const {
    const double Tf = gains_.filter.Tf;
    if (filters_setpoint() && (i == order_ - 1 || j == order_ - 1)) return rate_by_seen(i, j);
    switch (gains_.filter.type) {
        case FilterType::none: return 0;
        case FilterType::derivative: return i == 1 && j == 1 ? -1 / Tf : 0;
        case FilterType::measurement_first_order: return j != 1 ? 0 : i == 1 ? -1 / Tf : -gains_.Ki;
        case FilterType::measurement_second_order:
            if (i == 0) return j == 1 ? -gains_.Ki : 0;
            if (i == 1) return j == 2 ? 1 / Tf : 0;
            return j > 0 ? -2 / Tf : 0;
    }
    return 0;
}

double PidLaw::rate_by_seen(int i, int j) const {
    if (j != order_ - 1) return 0;
    if (i == j) return -1 / gains_.setpoint_lag;
    if (i == 0) return gains_.Ki;
    return i == 1 && gains_.filter.type == FilterType::derivative ? gains_.c / gains_.filter.Tf : 0;
}

double PidLaw::error_integral_to_rest(std::span<const double> s, double integral_final) const {
    // The remaining integral of r - y_f, minus the integral of y - y_f, which follows from the filter's equation.
    double rest = (integral_final - s[0]) / gains_.Ki;
    if (filters_setpoint()) rest += gains_.setpoint_lag * (r_ - seen(s));
    if (gains_.filter.type == FilterType::measurement_first_order) rest -= gains_.filter.Tf * (r_ - s[1]);
    if (gains_.filter.type == FilterType::measurement_second_order) rest -= gains_.filter.Tf * (r_ - s[1] - 0.5 * s[2]);
    return rest;
}

}  // namespace tunewright
