// The sampled law as it runs: one call a sample, states within, limits and dead band of a real program.
#pragma once

#include <optional>
#include <vector>

#include "engine/controller/sampled/sampled_pid.h"

namespace tunewright {

/// What a program has beside the linear law.
struct ProgramLimits {
    std::optional<ActuatorLimits>
        output;               ///< of u, deviations. Its integral waits while it would drive u beyond a
                              ///< limit, which u is at meanwhile; a velocity algorithm has nothing that winds up
    double u_resolution = 0;  ///< >= 0: u is rounded to a multiple of it, within the limits
    double y_resolution = 0;  ///< >= 0: y is read as a multiple of it
    double dead_band = 0;     ///< >= 0: a smaller |r - y| counts as none

    bool linear() const { return !output && u_resolution == 0 && y_resolution == 0 && dead_band == 0; }
};

/// At rest, all states 0, until the first step, or as take_over() leaves it.
class PidProgram {
public:
    explicit PidProgram(const SampledPid& law, const ProgramLimits& limits = {});

    /// Bumpless transfer to automatic: all states as after a long rest at this set point, measurement and output, with
    /// an integral that gives the output u now. From then on output limits and rounding apply to u itself.
    void take_over(double r, double y, double u);

    /// The output u_k for what is read at t_k.
    double step(double r, double y);

private:
    double filtered(double y);
    double filtered_trapezoidal(double y);
    double derivative(double f);
    double integral_increment(double e) const;

    SampledPid law_;
    ProgramLimits limits_;
    double r_f_ = 0;          // the set point's filter
    double y_f_ = 0, v_ = 0;  // the measurement's filter
    double y_before_ = 0, set_before_ = 0;
    std::vector<double> past_;  // f of the samples before, the latest first
    double D_ = 0, I_ = 0, e_ = 0;
    double P_ = 0, u_ = 0;  // of the sample before, for the velocity algorithm
};

}  // namespace tunewright
