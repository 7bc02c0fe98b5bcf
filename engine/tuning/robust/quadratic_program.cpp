#include "engine/tuning/robust/quadratic_program.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace tunewright::robust {
namespace {

using Index = std::size_t;

constexpr double kSingular = 1e-13;   // of the active rows' determinant, over the product of their own sizes
constexpr double kNegative = -1e-10;  // a multiplier below it pulls in the wrong direction; above it, it is rounding
constexpr double kSlack = 1e-9;       // of a constraint, absolute and relative to its b

/// lambda of a system of up to three equations with the symmetric matrix m; false where it is singular.
bool solve(const std::array<std::array<double, 3>, 3>& m, const std::array<double, 3>& right, Index n,
           std::array<double, 3>& lambda) {
    if (n == 1) {
        lambda[0] = right[0] / m[0][0];
        return m[0][0] > 0;
    }
    const double minor = m[0][0] * m[1][1] - m[0][1] * m[0][1];
    if (!(minor > kSingular * m[0][0] * m[1][1])) return false;
    if (n == 2) {
        lambda[0] = (right[0] * m[1][1] - right[1] * m[0][1]) / minor;
        lambda[1] = (right[1] * m[0][0] - right[0] * m[0][1]) / minor;
        return true;
    }
    const double c0 = m[0][1] * m[1][2] - m[0][2] * m[1][1], c1 = m[0][2] * m[0][1] - m[0][0] * m[1][2];
    const double determinant = m[2][0] * c0 + m[2][1] * c1 + m[2][2] * minor;
    if (!(determinant > kSingular * m[0][0] * m[1][1] * m[2][2])) return false;
    lambda[2] = (right[0] * c0 + right[1] * c1 + right[2] * minor) / determinant;
    const std::array<double, 3> rest = {right[0] - m[0][2] * lambda[2], right[1] - m[1][2] * lambda[2], 0};
    return solve(m, rest, 2, lambda);
}

/// The program in its constraints' terms. With W = 1/H the point p = -W (g + sum lambda_k a_k) exceeds constraint i by
/// v_i - sum lambda_k a_i W a_k, where v_i is what the free minimum -W g exceeds it by: an active set asks for a system
/// of its own size, and its check for as many products as there are constraints.
class Program {
public:
    Program(int n, const Matrix3& H, const Vector3& g, const std::vector<LinearConstraint>& constraints)
        : constraints_(constraints), size_(constraints.size()) {
        Matrix3 padded = Matrix3::Identity();
        padded.topLeftCorner(n, n) = H.topLeftCorner(n, n);
        Vector3 gradient = Vector3::Zero();
        gradient.head(n) = g.head(n);
        const Eigen::LLT<Matrix3> factored(padded);
        free_ = -factored.solve(gradient);
        moved_by_.reserve(size_);
        excess_.reserve(size_);
        products_.resize(size_ * size_);
        for (Index i = 0; i < size_; ++i) {
            Vector3 a = Vector3::Zero();
            a.head(n) = constraints[i].a.head(n);
            moved_by_.push_back(factored.solve(a));
            excess_.push_back(a.dot(free_) - constraints[i].b);
            for (Index k = 0; k <= i; ++k) products_[i * size_ + k] = products_[k * size_ + i] = a.dot(moved_by_[k]);
        }
    }

    Index size() const { return size_; }

    /// The stationary point with the given constraints as equations; kept if it satisfies all others and pulls in the
    /// right direction.
    std::optional<QuadraticSolution> attempt(const std::array<Index, 3>& active, Index count) const {
        std::array<std::array<double, 3>, 3> m{};
        std::array<double, 3> right{}, lambda{};
        for (Index k = 0; k < count; ++k) {
            right[k] = excess_[active[k]];
            for (Index l = 0; l < count; ++l) m[k][l] = products_[active[k] * size_ + active[l]];
        }
        if (count > 0 && !solve(m, right, count, lambda)) return std::nullopt;
        for (Index k = 0; k < count; ++k)
            if (lambda[k] < kNegative) return std::nullopt;
        for (Index i = 0; i < size_; ++i) {
            double excess = excess_[i];
            for (Index k = 0; k < count; ++k) excess -= products_[i * size_ + active[k]] * lambda[k];
            if (excess > kSlack * (1 + std::abs(constraints_[i].b))) return std::nullopt;
        }
        QuadraticSolution solution;
        solution.p = free_;
        solution.multipliers.assign(size_, 0);
        for (Index k = 0; k < count; ++k) {
            solution.p -= moved_by_[active[k]] * lambda[k];
            solution.multipliers[active[k]] = std::max(0.0, lambda[k]);
        }
        return solution;
    }

private:
    const std::vector<LinearConstraint>& constraints_;
    Index size_;
    Vector3 free_;
    std::vector<Vector3> moved_by_;  // W a
    std::vector<double> excess_, products_;
};

}  // namespace

std::optional<QuadraticSolution> solve_quadratic_program(int n, const Matrix3& H, const Vector3& g,
                                                         const std::vector<LinearConstraint>& constraints) {
    const Program program(n, H, g, constraints);
    const Index m = program.size();
    if (auto free = program.attempt({}, 0)) return free;
    for (Index i = 0; i < m; ++i)
        if (auto one = program.attempt({i}, 1)) return one;
    for (Index i = 0; n > 1 && i < m; ++i)
        for (Index j = i + 1; j < m; ++j)
            if (auto two = program.attempt({i, j}, 2)) return two;
    for (Index i = 0; n > 2 && i < m; ++i)
        for (Index j = i + 1; j < m; ++j)
            for (Index k = j + 1; k < m; ++k)
                if (auto three = program.attempt({i, j, k}, 3)) return three;
    return std::nullopt;
}

}  // namespace tunewright::robust
