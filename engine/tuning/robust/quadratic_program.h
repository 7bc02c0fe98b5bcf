// A convex quadratic program in at most three unknowns, solved exactly by trying active sets.
#pragma once

#include <array>
#include <optional>
#include <vector>

namespace tunewright::robust {

using Vector3 = std::array<double, 3>;
using Matrix3 = std::array<Vector3, 3>;

/// a . p <= b
struct LinearConstraint {
    Vector3 a{};
    double b = 0;
};

struct QuadraticSolution {
    Vector3 p{};
    std::vector<double> multipliers;  ///< one a constraint, >= 0
};

/// Minimises g.p + p.H p/2 over the first n unknowns subject to the constraints. H is positive definite there. Empty:
/// infeasible.
std::optional<QuadraticSolution> solve_quadratic_program(int n, const Matrix3& H, const Vector3& g,
                                                         const std::vector<LinearConstraint>& constraints);

}  // namespace tunewright::robust
