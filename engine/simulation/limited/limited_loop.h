// A loop with actuator limits as three linear systems (below, within and above the limits), and its state of rest.
#pragma once

#include <vector>

#include "engine/controller/pid.h"
#include "engine/loop/delay_system.h"
#include "engine/numerics/propagator.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/simulation/limited/limited_response.h"
#include "engine/simulation/linear/response_end.h"

namespace tunewright {

/// Position of the controller's command relative to the limits.
enum class Region { below, inside, above };

/// The loop's outputs at one instant.
struct LoopOutput {
    Signal y;
    Signal command;  ///< of the controller, before the limits
    Signal u;        ///< after them
};

/// The delay system of `make_delay_system` with one more state, the integral of y - r, and the tracking term.
class LimitedLoop {
public:
    /// `tracking_gain`: 1/(Ki Tt), 0 without integral action (tracking_gain_of).
    LimitedLoop(DelaySystem system, double tracking_gain, const StepInputs& inputs, const ActuatorLimits& limits);

    int states() const { return system_.n + 1; }
    double dead_time() const { return system_.L; }
    bool delayed() const { return system_.L > 0; }
    const DelaySystem& system() const { return system_; }

    /// The region for states x and delayed signal v (not used without dead time). At a limit the command's slope
    /// decides.
    Region region(const std::vector<double>& x, Signal v) const;
    /// The region after the command has crossed a limit.
    Region region_after(Region before, bool at_max) const;
    double limit(Region region) const { return region == Region::above ? limits_.max : limits_.min; }

    LoopOutput output(Region region, const std::vector<double>& x, Signal v) const;
    /// The exact step of length h; without dead time its Gamma is 0, because the delayed signal is part of the system.
    ExactStep step(Region region, double h) const;

private:
    struct Equations {
        std::vector<double> F, G, b;
    };
    Equations equations(Region region) const;
    double command(const std::vector<double>& x, double v) const;
    std::vector<double> rates(Region region, const std::vector<double>& x, double v) const;

    DelaySystem system_;
    StepInputs in_;
    ActuatorLimits limits_;
    double tracking_gain_;
    Equations below_, inside_, above_;
};

double tracking_gain_of(const LinearPlant& plant, const ParallelPid& controller);

/// The loop's rest within its limits, or at one of them. There is no rest if a limit holds an integrating or unstable
/// plant.
SteadyState within_limits(const SteadyState& linear, const LinearPlant& plant, const ActuatorLimits& limits, double d);

}  // namespace tunewright
