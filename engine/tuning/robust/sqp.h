// A robust design by sequential quadratic programming (numerics/optimise/sqp.h has its steps) over the logarithms of
// (Kp, Ti, Td): every iterate is moved back within the limits, so it can be stopped at any time.
#pragma once

#include <functional>
#include <limits>
#include <optional>

#include "engine/tuning/robust/cost.h"
#include "engine/tuning/robust/sweep/sweep.h"

namespace tunewright::robust {

struct SqpOptions {
    int max_iterations = 40;
    double cost_tolerance = 1e-5;  ///< stops when the model promises less than this of ln(cost)
    double simulation_tolerance = 3e-4;
    double trust_radius = 0.5;                ///< of a logarithm
    bool stable_start = false;                ///< the start's loop is known to be stable
    std::optional<Curvature> curvature = {};  ///< seen near by
    /// ln(cost) that counts: a run ends, not converged, where many times what the model promises leads not below it.
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
/// inside (of a constraint's logarithm); up to 1e-8 outside is accepted. Empty if that does not succeed.
std::optional<DesignPoint> restore(const Sweep& sweep, DesignPoint x);

/// The peak that `old`, of another design near by, has become: of its kind and plant the nearest, within 0.3 of ln
/// omega; null where there is none.
const ActivePeak* same_peak(const std::vector<ActivePeak>& peaks, const ActivePeak& old);

/// Is the loop at x stable, on every plant?
bool is_stable(const DesignProblem& problem, const DesignPoint& x);

/// `x` moved within the problem's limits, if that succeeds with a stable loop.
std::optional<DesignPoint> feasible_near(const Sweep& sweep, const DesignPoint& x);

}  // namespace tunewright::robust
