// The PID law as differential equations, for a loop whose plant is integrated numerically.
#pragma once

#include <optional>
#include <span>

#include "engine/controller/pid.h"

namespace tunewright {

/// States s: the integral part (in units of u), then the filter's (none, x_f; y_f; y_f and Tf y_f'), then the filtered
/// set point where it is filtered. The command is linear in y, y' and s; without `delta_r` the rates are too. y'
/// appears only in a derivative without a filter.
class PidLaw {
public:
    static constexpr int kMaxStates = 4;

    /// `delta_r`: for the nonlinear PID, the scale of its integral's input. `tracking_rate`: 1/Tt of the anti-windup.
    PidLaw(const ParallelPid& gains, double r, std::optional<double> delta_r, double tracking_rate);

    int order() const { return order_; }
    bool integrates() const { return gains_.Ki != 0; }
    /// True: the command depends on y' itself.
    bool pure_derivative() const { return gains_.Kd != 0 && gains_.filter.type == FilterType::none; }

    /// Sets the states to rest with the output y and an integral of 0.
    void rest(double y, std::span<double> s) const;
    double command(double y, double y_slope, std::span<const double> s) const;
    /// `excess`: u - command.
    void rates(double y, std::span<const double> s, double excess, std::span<double> ds) const;

    double command_by_y() const { return by_y_; }
    double command_by_state(int i) const { return by_state_[i]; }
    /// d(ds_i)/dy and d(ds_i)/ds_j with a constant excess.
    double rate_by_y(int i, double y) const;
    double rate_by_state(int i, int j) const;
    double tracking_rate() const { return tracking_rate_; }

    /// The integral part at rest where y = r, with the input u.
    double integral_at_rest(double u) const { return u - gains_.Kp * (gains_.b - 1) * r_; }
    /// The command at rest without integral action.
    double command_at_rest(double y) const { return gains_.Kp * (gains_.b * r_ - y); }
    double command_at_rest_by_y() const { return -gains_.Kp; }
    /// The integral of r - y from these states on to rest at r, where the integral part becomes `integral_final`.
    double error_integral_to_rest(std::span<const double> s, double integral_final) const;

private:
    double rate_by_seen(int i, int j) const;
    bool filters_setpoint() const { return gains_.setpoint_lag > 0; }
    /// The set point as the law uses it.
    double seen(std::span<const double> s) const { return filters_setpoint() ? s[std::size_t(order_ - 1)] : r_; }

    ParallelPid gains_;
    double r_;
    std::optional<ErrorScaling> scaling_;
    double tracking_rate_;
    int order_ = 1;
    double by_y_ = 0, by_state_[kMaxStates] = {1, 0, 0, 0};
};

}  // namespace tunewright
