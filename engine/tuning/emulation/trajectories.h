// The runs of the nonlinear controller, which the PID is to resemble.
#pragma once

#include "engine/tuning/emulation/problem.h"

namespace tunewright::emulation {

/// problem.intervals + 1 values from 0 to the horizon; deviations from the scenario's own steady state.
struct Trajectory {
    std::vector<double> y_nl, u_nl;
    double y_size = 0, u_size = 0;  ///< int y_nl^2 dt, int u_nl^2 dt
    bool limited = false;
};

/// One a scenario. Errors: unsupported where the nonlinear controller itself cannot run to the horizon; cancelled.
Expected<std::vector<Trajectory>> nonlinear_trajectories(const EmulationProblem& problem, const RunControl& control);

/// int of the samples from 0 to the horizon by Simpson's rule: the sum of samples times these weights.
std::vector<double> simpson_weights(const EmulationProblem& problem);

}  // namespace tunewright::emulation
