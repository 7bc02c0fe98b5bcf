// What a robust design minimises, and its gradient, over the logarithms of the controller's parameters.
#pragma once

#include <array>
#include <optional>

#include "engine/simulation/linear/linear_response.h"
#include "engine/tuning/robust/design.h"

namespace tunewright::robust {

/// Integrated absolute error of a unit load step (or unit set-point step). The loop must be stable. Empty: it did not
/// settle.
std::optional<double> step_iae(const DesignProblem& problem, const DesignPoint& x, bool setpoint, double tolerance);

/// Stands for ln of the cost where there is no design, whatever the units: finite, as a simplex needs it.
constexpr double kNoDesign = 700;

/// ln of the cost; +infinity where it cannot be computed. The loop must be stable.
double log_cost(const DesignProblem& problem, const DesignPoint& x, double tolerance);

/// A lower bound of `log_cost` that needs no simulation: the integral of |e| is at least |integral of e|, which is
/// Ti/|Kp| after a unit load step and |Ti/(Kp P(0)) - Tf| after a unit set-point step (Tf with an integrator), because
/// the integral action sees the filtered y.
double log_cost_bound(const DesignProblem& problem, const DesignPoint& x);

struct CostWithGradient {
    double value = 0;
    std::array<double, 3> gradient{};
};

/// ln of the cost and its derivatives by the logarithms: forward differences of runs on the same instants, so that the
/// error of the time grid cancels; exact for `load_ie`.
CostWithGradient log_cost_with_gradient(const DesignProblem& problem, const DesignPoint& x, double tolerance);

}  // namespace tunewright::robust
