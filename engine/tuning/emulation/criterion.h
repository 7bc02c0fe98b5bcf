// J of a PID: the mean over the scenarios of int_0^horizon wy (y_nl - y)^2 + wu (u_nl - u)^2 dt (Eq. 2). Its reference
// are the runs of the nonlinear controller, which the PID is to emulate.

#pragma once

#include "engine/tuning/emulation/emulation_problem.h"

namespace tunewright::emulation {

/// problem.intervals + 1 values from 0 to the horizon; deviations from the scenario's own steady state.
struct Trajectory {
    std::vector<double> y_nl, u_nl;
    double y_size = 0, u_size = 0;  ///< int y_nl^2 dt, int u_nl^2 dt
    bool limited = false;
};

/// One for each scenario. Errors: unsupported if the nonlinear controller itself cannot run to the horizon; cancelled.
Expected<std::vector<Trajectory>> nonlinear_trajectories(const EmulationProblem& problem, const RunControl& control);

/// Weights of Simpson's rule: the integral from 0 to the horizon is the sum of samples times these weights.
std::vector<double> simpson_weights(const EmulationProblem& problem);

/// The PID's own run of one scenario; deviations. Shorter than the horizon if it ended early.
struct PidRun {
    std::vector<double> y, u;
    double share = 1;   ///< fraction of the horizon
    std::string ended;  ///< the reason for an early end; empty: none
};

struct Cost {
    double J = 0, J_y = 0, J_u = 0;  ///< of the part that was simulated
    double share = 1;                ///< fraction of the horizon, of the run that ended first
    std::string ended;               ///< the reason for its end; empty: every run reached the horizon
};

/// Computes J by simulation on the nonlinear plant.
class Criterion {
public:
    Criterion(const EmulationProblem& problem, const std::vector<Trajectory>& trajectories);

    /// `stop` ends the run early.
    PidRun run(std::size_t scenario, const IdealPid& pid, double tolerance, const std::stop_token& stop = {}) const;
    Cost cost(const IdealPid& pid, double tolerance, const std::stop_token& stop = {}) const {
        return weigh(pid, tolerance, stop, nullptr);
    }
    /// The same, with residuals whose squares sum to J.
    Cost cost(const IdealPid& pid, double tolerance, const std::stop_token& stop,
              std::vector<double>& residuals) const {
        return weigh(pid, tolerance, stop, &residuals);
    }
    /// J, or a larger value if a run ended early: the earlier, the larger. Finite.
    double penalised(const Cost& cost) const;

    const EmulationProblem& problem() const { return problem_; }
    const std::vector<Trajectory>& trajectories() const { return trajectories_; }

private:
    Cost weigh(const IdealPid& pid, double tolerance, const std::stop_token& stop,
               std::vector<double>* residuals) const;

    const EmulationProblem& problem_;
    const std::vector<Trajectory>& trajectories_;
    std::vector<double> weights_;
    double at_rest_ = 0;  // J if nothing moves
};

}  // namespace tunewright::emulation
