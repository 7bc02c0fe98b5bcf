// A convex quadratic program of some tens of unknowns and some hundreds of constraints, as the joint search's steps
// are. robust/quadratic_program.h tries active sets instead: exact and quicker for up to three unknowns.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace tunewright::range {

struct QuadraticProgram {
    Eigen::MatrixXd H;  ///< n x n, symmetric, positive definite
    Eigen::VectorXd g;  ///< n
    Eigen::MatrixXd A;  ///< m x n
    Eigen::VectorXd b;  ///< m
};

struct ProgramSolution {
    Eigen::VectorXd z;            ///< n
    Eigen::VectorXd multipliers;  ///< m, > 0; next to 0 where a constraint is not active
};

/// The minimum of z'Hz/2 + g'z subject to A z <= b, by the predictor-corrector interior-point method (Mehrotra 1992,
/// SIAM J. Optimization 2, 575-601). Constraints and optimality hold to 1e-9, entries being of the order of 1.
///
/// H need be definite only along the directions that no constraint with a multiplier fixes, but its least eigenvalue
/// decides how well z is determined: give unknowns that enter linearly a small curvature.
///
/// Empty where there is no feasible point or the iteration does not converge (80 iterations, or a matrix that rounding
/// has made indefinite). Cost: some 15 factorisations of n x n.
std::optional<ProgramSolution> solve(const QuadraticProgram& program);

}  // namespace tunewright::range
