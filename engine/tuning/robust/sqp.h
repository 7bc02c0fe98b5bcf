// A robust design by sequential quadratic programming (numerics/optimise/sqp.h has its steps) over the logarithms of
// (Kp, Ti, Td): every iterate is moved back within the limits, so the search can be stopped at any time. One iteration
// (sqp.cpp):
//
//  1. Linearise the cost and the largest peaks at the current design; the quadratic program gives a step.
//  2. Restore feasibility by Newton steps on the violated peaks, and check the stability.
//  3. Compute the cost there and accept or reject the step by the ratio of the actual to the predicted decrease.
//  4. Update the Hessian by the change of the gradients, and the trust region by the ratio.
#pragma once

#include <functional>
#include <limits>
#include <optional>

#include "engine/tuning/robust/cost.h"
#include "engine/tuning/robust/sweep/sweep.h"

namespace tunewright::robust {

struct SqpOptions {
    int max_iterations = 40;
    double cost_tolerance = 1e-5;  ///< stops if the model predicts a smaller decrease of ln(cost)
    double simulation_tolerance = 3e-4;
    double trust_radius = 0.5;                ///< in each logarithm
    bool stable_start = false;                ///< the start's loop is known to be stable
    std::optional<Curvature> curvature = {};  ///< curvature of a design nearby
    /// ln(cost) that a run must reach: if not even a multiple of the decrease that the model predicts leads below it,
    /// the run ends, not converged.
    double wanted = std::numeric_limits<double>::infinity();
};

struct SqpResult {
    DesignPoint x{};
    double log_cost = 0;
    int iterations = 0;
    bool converged = false;
    bool stable = false;  ///< the loop at x is known to be stable
    std::optional<Curvature> curvature = {};
};

/// `report` is called after every accepted step; false stops the search.
using Report = std::function<bool(const DesignPoint&, double log_cost)>;

/// `start` must be stable and feasible to 1e-3.
SqpResult minimise(const Sweep& sweep, const DesignProblem& problem, const DesignPoint& start,
                   const SqpOptions& options, const Report& report);

/// Moves x to the feasible side by Newton steps on the violated peaks, along the shortest way. The steps aim 1e-7
/// inside (in a constraint's logarithm); a violation of up to 1e-8 is accepted. Empty if it does not succeed.
std::optional<DesignPoint> restore(const Sweep& sweep, DesignPoint x);

/// The peak that corresponds to `old`, a peak of another design nearby: the nearest of the same kind and plant, within
/// 0.3 in ln omega; null if there is none.
const ActivePeak* same_peak(const std::vector<ActivePeak>& peaks, const ActivePeak& old);

/// True if the loop at x is stable on every plant.
bool is_stable(const DesignProblem& problem, const DesignPoint& x);

/// `x` moved within the problem's limits, if this succeeds with a stable loop.
std::optional<DesignPoint> feasible_near(const Sweep& sweep, const DesignPoint& x);

}  // namespace tunewright::robust
