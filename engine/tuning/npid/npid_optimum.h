// The nonlinear PID that minimises an integral of the error after a set-point step, on any linear plant.
#pragma once

#include <optional>

#include "engine/controller/pid.h"
#include "engine/expected.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/progress.h"

namespace tunewright {

enum class ErrorCriterion { ISE, IAE, ITAE };

struct NpidProblem {
    const LinearPlant& plant;
    ErrorCriterion criterion = ErrorCriterion::IAE;
    double Tf_over_Td = 0;               ///< relative filter time of the derivative; 0: none
    std::optional<double> Tf = {};       ///< fixed instead
    std::optional<IdealPid> start = {};  ///< a rule's settings, as an additional start
};

struct NpidOptimum {
    IdealPid controller;    ///< linear part
    double cost = 0;        ///< for a unit step, delta_r 1
    bool at_bound = false;  ///< at the edge of the search region
    bool stopped = false;   ///< stopped by control.stop, with the best so far
};

/// DIRECT over the logarithms of Kp, Ti, Td (in units of the plant's ultimate gain and period), then subplex searches
/// from its best points and from `start`, where the source uses a genetic algorithm. Stable loops only; a neutral loop
/// needs |L(infinity)| < 1. Deterministic, about 1,500 responses at most. Kp has the sign of the ultimate gain. A plant
/// with a direct term gets a PI if there is no filter. Errors: unbounded_optimum (no dead time and pole excess up to 2:
/// a higher gain is always better), unsupported (no ultimate gain), no_feasible_controller, cancelled.
Expected<NpidOptimum> find_npid_optimum(const NpidProblem& problem, const RunControl& control);

}  // namespace tunewright
