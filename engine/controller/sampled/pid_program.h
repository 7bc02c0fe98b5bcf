// The sampled law as a running program: one call per sample, internal states, limits and dead band.
#pragma once

#include <optional>
#include <vector>

#include "engine/controller/sampled/sampled_pid.h"

namespace tunewright {

/// The nonlinear parts of a program.
struct ProgramLimits {
    std::optional<ActuatorLimits> output;  ///< limits of u, deviations. The integral stops while it would drive u
                                           ///< beyond; a velocity algorithm has none that winds up
    double u_resolution = 0;               ///< >= 0: u is rounded to a multiple of it, within the limits
    double y_resolution = 0;               ///< >= 0: y is rounded to a multiple of it
    double dead_band = 0;                  ///< >= 0: a smaller |r - y| counts as 0

    bool linear() const { return !output && u_resolution == 0 && y_resolution == 0 && dead_band == 0; }
};

/// At rest, all states 0, until the first step, or as take_over() leaves it.
class PidProgram {
public:
    explicit PidProgram(const SampledPid& law, const ProgramLimits& limits = {});

    /// Bumpless transfer to automatic: all states are as after a long rest at this set point, measurement and output,
    /// and the integral gives the present output u. From then on output limits and rounding apply to u itself.
    void take_over(double r, double y, double u);

    /// The output u_k for r and y read at t_k.
    double step(double r, double y);

private:
    double filtered(double y);
    double filtered_trapezoidal(double y);
    double derivative(double f);
    double integral_increment(double e) const;

    SampledPid law_;
    ProgramLimits limits_;
    double r_f_ = 0;          // state of the set point's filter
    double y_f_ = 0, v_ = 0;  // states of the measurement's filter
    double y_before_ = 0, set_before_ = 0;
    std::vector<double> past_;  // f of the previous samples, the latest first
    double D_ = 0, I_ = 0, e_ = 0;
    double P_ = 0, u_ = 0;  // of the previous sample, for the velocity algorithm
};

}  // namespace tunewright
