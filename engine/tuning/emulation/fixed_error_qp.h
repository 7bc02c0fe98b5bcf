// Remark 6: the PID's error taken from the nonlinear controller's run, u compared alone. Its u is then linear in Kp,
// Kp/Ti and Kp Td, and the least-squares problem is solved exactly inside the bounds.

#pragma once

#include <array>
#include <optional>

#include "engine/numerics/optimise/quadratic_program.h"
#include "engine/tuning/emulation/criterion.h"
#include "engine/tuning/emulation/emulation_problem.h"

namespace tunewright::emulation {

class FixedErrorQp {
public:
    FixedErrorQp(const EmulationProblem& problem, const std::vector<Trajectory>& trajectories);

    /// wu times the mean of int (u_nl - u)^2 dt. Where u_nl rests on a limit of the input, what u asks for beyond it
    /// does not count: the limit would take it away.
    double J(const SettingsPoint& point) const;

    /// The best point within the bounds; a free Tf by a one-dimensional search around. Empty: no Kp other than 0.
    std::optional<SettingsPoint> best(const Bounds& bounds) const;

private:
    /// At every sample of every scenario: what multiplies Kp, Kp/Ti and Kp Td in u.
    using Signals = std::array<std::vector<double>, 3>;
    struct BestPoint {
        SettingsPoint point;
        double J = 0;
    };

    Signals signals(double Tf) const;
    double J_of(const Eigen::Vector3d& gains, const Signals& signals, std::vector<bool>* beyond) const;
    std::optional<BestPoint> best_with(double Tf, const Bounds& bounds) const;
    std::optional<BestPoint> best_of_sign(double sign, double Tf, const Signals& signals, const Bounds& bounds) const;

    const EmulationProblem& problem_;
    const std::vector<Trajectory>& trajectories_;
    std::vector<double> weights_;        // of a sample in J, all scenarios one after the other
    std::vector<double> u_nl_;           // likewise
    std::vector<signed char> at_limit_;  // -1 the lower, 1 the upper
    Signals fixed_;                      // with the fixed filter
};

}  // namespace tunewright::emulation
