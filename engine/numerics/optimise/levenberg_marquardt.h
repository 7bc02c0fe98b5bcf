// Levenberg-Marquardt: sums of squares of residuals whose derivatives the problem gives (Marquardt 1963, J. SIAM 11,
// 431-441).
//
//  1. Linearise: the problem computes its normal equations J'J d = -J'r at the present point.
//  2. Damp: the diagonal grows by `damping` times itself, which shortens the step and turns it downhill.
//  3. Try: the problem computes the sum at the step's end. Where it fell the damping falls and 1 follows, otherwise the
//     damping rises and 2 follows.
//  4. The problem ends it where a step changes or promises too little, and the damping where steps are rounding.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <concepts>

namespace tunewright::optimise {

/// Marquardt's scheme; the factors are the fit's, found on recorded steps (bench/identify_bench measures it).
struct MarquardtDamping {
    double first = 1e-3;         ///< of the diagonal: nearly Gauss and Newton's step
    double min = 1e-9;           ///< below it steps are Gauss and Newton's
    double max = 1e10;           ///< from it on steps are rounding
    double ease = 8;             ///< divides it after a step that was taken
    double tighten = 6;          ///< multiplies it after one that was not; unequal: no cycle between two dampings
    double insensitive = 1e-12;  ///< of the largest diagonal entry: what nothing depends on is damped all the same
};

enum class Trial {
    better,  ///< the sum fell, and the problem moved there
    worse,
    end,  ///< nothing more is to be won, or the problem was asked to stop
};

template <class Problem>
concept LeastSquaresProblem = requires(Problem& problem, double damping) {
    /// False: there is nothing to step along.
    { problem.linearise() } -> std::same_as<bool>;
    { problem.try_step(damping) } -> std::same_as<Trial>;
};

/// The number of linearisations whose steps were taken.
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
