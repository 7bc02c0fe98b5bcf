// The cost of a robust design and its gradient, over the logarithms of the controller's parameters.
#pragma once

#include <array>
#include <optional>

#include "engine/simulation/linear/linear_response.h"
#include "engine/tuning/robust/design.h"

namespace tunewright::robust {

/// Integrated absolute error of a unit load step (or unit set-point step). The loop must be stable. Empty if it does
/// not settle.
std::optional<double> step_iae(const DesignProblem& problem, const DesignPoint& x, bool setpoint, double tolerance);

/// ln of the cost if there is no design, in any units: finite, because a simplex needs a finite value.
constexpr double kLogCostOfNoDesign = 700;

/// ln of the cost; +infinity if it cannot be computed. The loop must be stable.
double log_cost(const DesignProblem& problem, const DesignPoint& x, double tolerance);

/// A lower bound of `log_cost` that needs no simulation: the integral of |e| is at least |integral of e|, which is
/// Ti/|Kp| after a unit load step and |Ti/(Kp P(0)) - Tf| after a unit set-point step (Tf with an integrator), because
/// the integral action acts on the filtered y.
double log_cost_bound(const DesignProblem& problem, const DesignPoint& x);

struct CostWithGradient {
    double value = 0;
    std::array<double, 3> gradient{};
};

/// A design with its known cost, and the simulations that gave it.
class EvaluatedDesign {
public:
    EvaluatedDesign(const DesignProblem& problem, const DesignPoint& x, double tolerance);

    /// ln of the cost, as by `log_cost`.
    double log_cost() const { return log_cost_; }

    /// The cost with its derivatives by the logarithms: forward differences of runs at the same times, so that the
    /// error of the time grid cancels; exact for `load_ie` and for a load error that keeps its sign, whose IAE is
    /// Ti/Kp. All derivatives are 0 if the cost is infinite.
    CostWithGradient with_gradient() const;

private:
    /// One response, and ln of its IAE.
    struct Part {
        double log_iae = 0;
        bool keeps_sign = false;  // the error
        StepResponse response;
    };
    Part evaluated(bool setpoint) const;
    std::array<double, 3> gradient() const;  // the cost must be finite
    std::array<double, 3> gradient_of(const Part& part, bool setpoint) const;

    const DesignProblem* problem_;
    DesignPoint x_;
    double tolerance_;
    Part load_, setpoint_;  // those that the objective needs
    double log_cost_ = 0;
};

}  // namespace tunewright::robust
