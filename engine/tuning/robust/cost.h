// What a robust design minimises, and its gradient, over the logarithms of the controller's parameters.
#pragma once

#include <array>
#include <optional>

#include "engine/simulation/linear_response.h"
#include "engine/tuning/robust/design.h"

namespace tunewright::robust {

/// Integrated absolute error of a unit load step (or unit set-point step). The loop must be stable. Empty: it did not
/// settle.
std::optional<double> step_iae(const Problem& problem, const Point& x, bool setpoint, double tolerance);

/// ln of the cost; +infinity where it cannot be computed. The loop must be stable.
double log_cost(const Problem& problem, const Point& x, double tolerance);

struct CostWithGradient {
    double value = 0;
    std::array<double, 3> gradient{};
};

/// ln of the cost and its derivatives by the logarithms: forward differences of runs on the same instants, so that the
/// error of the time grid cancels; exact for `load_ie`.
CostWithGradient log_cost_with_gradient(const Problem& problem, const Point& x, double tolerance);

}  // namespace tunewright::robust
