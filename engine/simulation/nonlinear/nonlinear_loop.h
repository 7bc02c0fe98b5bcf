// A PID loop on a nonlinear plant as differential equations, below, within and above the limits of its input, and its
// state of rest.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/plant/nonlinear/nonlinear_system.h"
#include "engine/simulation/limited/limited_loop.h"
#include "engine/simulation/limited/limited_response.h"
#include "engine/simulation/nonlinear/pid_law.h"

namespace tunewright {

/// The limits of u by the plant and by the actuator, as deviations; infinite without a limit.
ActuatorLimits input_limits(const NonlinearSystem& system, const std::optional<ActuatorLimits>& actuator);

/// 1/Tt of the anti-windup (limited_response.h) for the plant's linearisation; 0 if nothing can wind up.
double back_calculation_rate(const NonlinearSystem& system, const ParallelPid& controller,
                             const ActuatorLimits& limits);

/// The change of y by which a load d drives the linearisation over the plant's own time.
double size_of_effect(const NonlinearSystem& system, double d);

/// The number of passages through the loop after which a jump of the plant's input no longer matters. With a pure
/// derivative it returns after a dead time as a smaller jump, otherwise as a smoother kink.
int passages_that_count(const NonlinearSystem& system, const ParallelPid& controller, double tolerance);

/// States z: those of the plant (absolute), then those of the PidLaw. y, u, w = u + d are deviations.
class NonlinearLoop {
public:
    NonlinearLoop(const NonlinearSystem& system, const PidLaw& law, const StepInputs& inputs,
                  const ActuatorLimits& limits);

    struct Output {
        double y = 0, command = 0, u = 0;  ///< u after the limits
        bool exists = true;
    };

    int order() const { return system_.order() + law_.order(); }
    bool delayed() const { return system_.dead_time() > 0; }
    const NonlinearSystem& system() const { return system_; }
    const PidLaw& law() const { return law_; }
    const ActuatorLimits& limits() const { return limits_; }
    double limit(Region region) const { return region == Region::above ? limits_.max : limits_.min; }

    /// `w_then`: with a dead time the present input of the plant, which left the controller one dead time ago; not used
    /// without one.
    Output output(Region region, std::span<const double> z, double w_then) const;
    /// The region for these states: at a limit it is `inside`.
    Region region(std::span<const double> z, double w_then) const;
    /// False outside the plant's domain.
    bool rates(Region region, std::span<const double> z, double w_then, std::span<double> dz) const;

    /// Exact; not for a pure derivative.
    bool has_jacobian() const { return !law_.pure_derivative(); }
    bool jacobian(Region region, std::span<const double> z, double w_then, double w_then_slope, std::span<double> J,
                  std::span<double> ft) const;

    std::span<const double> plant_states(std::span<const double> z) const { return z.first(n_); }
    std::span<const double> law_states(std::span<const double> z) const { return z.subspan(n_); }

private:
    double y_of(std::span<const double> z) const;
    /// y' for the plant's input w; leaves f in slope_.
    bool y_slope(std::span<const double> x, double w, double& slope) const;
    Output output_of_pure_derivative(Region region, std::span<const double> z, double w_then) const;

    const NonlinearSystem& system_;
    PidLaw law_;
    StepInputs in_;
    ActuatorLimits limits_;
    std::size_t n_;
    mutable std::vector<double> slope_, C_, A_, B_;  // scratch
};

/// A state of rest of the loop.
struct NonlinearRest {
    bool within = false;    ///< true: by the control law; false: at a limit
    double y = 0, u = 0;    ///< deviations
    std::vector<double> x;  ///< absolute
};

/// The rest nearest to these states, by Newton's method: with the control law if the limits allow it, else at the
/// limit. Empty if none is found nearby. `sizes`: ranges of the states, and last of u, in this loop; much smaller
/// values are rounding.
std::optional<NonlinearRest> find_rest(const NonlinearLoop& loop, const StepInputs& inputs, std::vector<double> x,
                                       double u, const std::vector<double>& sizes);

}  // namespace tunewright
