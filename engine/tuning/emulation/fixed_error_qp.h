// Remark 6: the PID's error is that of the nonlinear controller's run, and only u is compared. Then u is linear in Kp,
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

    /// wu times the mean of int (u_nl - u)^2 dt. If u_nl is at a limit of the input, the part of u beyond the limit
    /// does not count, because the limit would remove it.
    double J(const SettingsPoint& point) const;

    /// The best point within the bounds; a free Tf is found by an outer one-dimensional search. Empty: no Kp other than
    /// 0.
    std::optional<SettingsPoint> best(const Bounds& bounds) const;

private:
    /// At every sample of every scenario: the factors of Kp, Kp/Ti and Kp Td in u.
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
    std::vector<double> weights_;        // weight of each sample in J, all scenarios one after the other
    std::vector<double> u_nl_;           // likewise
    std::vector<signed char> at_limit_;  // -1 at the lower, 1 at the upper limit
    Signals fixed_;                      // with the fixed filter
};

}  // namespace tunewright::emulation
