#include "engine/tuning/robust/quadratic_program.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <span>

namespace tunewright::robust {
namespace {

constexpr int kMaxSize = 6;           // unknowns and multipliers
constexpr double kSingular = 1e-13;   // the least pivot; H and the constraints' gradients are of the order of 1
constexpr double kNegative = -1e-10;  // a multiplier below it pulls in the wrong direction; above it, it is rounding
constexpr double kSlack = 1e-9;       // of a constraint, absolute and relative to its b

using System = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxSize, kMaxSize>;
using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxSize, 1>;

/// The stationary point with the given constraints as equations; kept if it satisfies all others and pulls in the right
/// direction.
std::optional<QuadraticSolution> try_active_set(int n, const Matrix3& H, const Vector3& g,
                                                const std::vector<LinearConstraint>& constraints,
                                                std::span<const int> active) {
    const int count = static_cast<int>(active.size());
    System A = System::Zero(n + count, n + count);
    Column right(n + count);
    A.topLeftCorner(n, n) = H.topLeftCorner(n, n);
    right.head(n) = -g.head(n);
    for (int k = 0; k < count; ++k) {
        const auto& constraint = constraints[std::size_t(active[std::size_t(k)])];
        A.col(n + k).head(n) = constraint.a.head(n);
        A.row(n + k).head(n) = constraint.a.head(n).transpose();
        right[n + k] = constraint.b;
    }
    const Eigen::PartialPivLU<System> lu(A);
    if (lu.matrixLU().diagonal().cwiseAbs().minCoeff() < kSingular) return std::nullopt;
    const Column x = lu.solve(right);
    if (count > 0 && x.tail(count).minCoeff() < kNegative) return std::nullopt;
    QuadraticSolution solution;
    solution.p.head(n) = x.head(n);
    for (const auto& c : constraints)
        if (c.a.dot(solution.p) > c.b + kSlack * (1 + std::abs(c.b))) return std::nullopt;
    solution.multipliers.assign(constraints.size(), 0);
    for (int k = 0; k < count; ++k) solution.multipliers[std::size_t(active[std::size_t(k)])] = std::max(0.0, x[n + k]);
    return solution;
}

}  // namespace

std::optional<QuadraticSolution> solve_quadratic_program(int n, const Matrix3& H, const Vector3& g,
                                                         const std::vector<LinearConstraint>& constraints) {
    const int m = static_cast<int>(constraints.size());
    const auto attempt = [&](std::initializer_list<int> active) {
        return try_active_set(n, H, g, constraints, {active.begin(), active.size()});
    };
    if (auto free = attempt({})) return free;
    for (int i = 0; i < m; ++i)
        if (auto one = attempt({i})) return one;
    for (int i = 0; i < m; ++i)
        for (int j = i + 1; j < m; ++j)
            if (auto two = attempt({i, j})) return two;
    if (n < 3) return std::nullopt;
    for (int i = 0; i < m; ++i)
        for (int j = i + 1; j < m; ++j)
            for (int k = j + 1; k < m; ++k)
                if (auto three = attempt({i, j, k})) return three;
    return std::nullopt;
}

}  // namespace tunewright::robust
