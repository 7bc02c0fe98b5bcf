// A convex quadratic program in at most three unknowns, solved exactly by trying active sets.

#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace tunewright::robust {

using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;

/// a . p <= b
struct LinearConstraint {
    Vector3 a = Vector3::Zero();
    double b = 0;
};

struct QuadraticSolution {
    Vector3 p = Vector3::Zero();      ///< 0 beyond the first n
    std::vector<double> multipliers;  ///< one for each constraint, >= 0; 0 where it is not active
};

/// Minimises g.p + p.H p/2 over the first n <= 3 unknowns subject to the constraints. H is positive definite there.
/// Constraints hold to 1e-9, relative to b where |b| > 1. Empty: infeasible, or every active set that may be the
/// solution's is singular.
///
/// Cost: one system of as many unknowns as there are constraints in a set, for each set of up to n constraints that is
/// tried.
std::optional<QuadraticSolution> solve_quadratic_program(int n, const Matrix3& H, const Vector3& g,
                                                         const std::vector<LinearConstraint>& constraints);

}  // namespace tunewright::robust
