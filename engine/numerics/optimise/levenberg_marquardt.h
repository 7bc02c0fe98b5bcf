// Levenberg-Marquardt: minimises sums of squares of residuals with given derivatives (Marquardt 1963, J. SIAM 11,
// 431-441).
//
//  1. Linearise: the problem computes its normal equations J'J d = -J'r at the current point.
//  2. Damp: the diagonal grows by `damping` times itself, which shortens the step and turns it towards the gradient.
//  3. Try: the problem computes the sum at the step's end. If it fell, the damping is lowered and 1 follows; otherwise
//     the damping is raised and 2 follows.
//  4. End: a step, or the decrease predicted for it, is too small (decided by the problem), or the damping reaches its
//     maximum.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <concepts>

namespace tunewright::optimise {

/// Marquardt's scheme; the factors were found for the model fit on recorded steps (bench/identify_bench measures them).
struct MarquardtDamping {
    double first = 1e-3;         ///< of the diagonal: nearly a Gauss-Newton step
    double min = 1e-9;           ///< below it steps are Gauss-Newton steps
    double max = 1e10;           ///< above it steps are only rounding
    double ease = 8;             ///< divides the damping after a successful step
    double tighten = 6;          ///< multiplies it after a failed step; differs from `ease`, so that no cycle between
                                 ///< two dampings occurs
    double insensitive = 1e-12;  ///< of the largest diagonal entry: least damping, for unknowns that nothing depends on
};

enum class Trial {
    better,  ///< the sum fell, and the problem moved to the new point
    worse,
    end,  ///< no further improvement is possible, or the problem was asked to stop
};

template <class Problem>
concept LeastSquaresProblem = requires(Problem& problem, double damping) {
    /// False: there is no direction for a step.
    { problem.linearise() } -> std::same_as<bool>;
    { problem.try_step(damping) } -> std::same_as<Trial>;
};

/// Returns the number of linearisations with a successful step.
template <LeastSquaresProblem Problem>
int levenberg_marquardt(Problem& problem, int max_iterations, const MarquardtDamping& constants = {}) {
    double damping = constants.first;
    int taken = 0;
    while (taken < max_iterations && damping < constants.max && problem.linearise()) {
        Trial trial = Trial::worse;
        while (trial == Trial::worse && damping < constants.max) {
            trial = problem.try_step(damping);
            damping = trial == Trial::better ? std::max(constants.min, damping / constants.ease)
                                             : damping * constants.tighten;
        }
        if (trial != Trial::better) break;
        ++taken;
    }
    return taken;
}

/// The normal matrix with its diagonal damped.
template <class Matrix>
Matrix damped(Matrix normal, double damping, const MarquardtDamping& constants = {}) {
    const double floor = constants.insensitive * normal.diagonal().maxCoeff();
    normal.diagonal() += damping * normal.diagonal().cwiseMax(floor);
    return normal;
}

}  // namespace tunewright::optimise
