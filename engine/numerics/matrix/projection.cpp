#include "engine/numerics/matrix/projection.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "engine/numerics/long_vectors.h"
#include "engine/numerics/matrix/dense.h"

namespace tunewright {
namespace {

/// A column is dependent if the part outside the others' span is relatively smaller than this.
constexpr double kMinIndependentShare = 1e-9;
/// A column that keeps this share of its length has lost at most one digit.
constexpr double kMinShareWithoutRepeat = 0.1;
constexpr double kMinColumnNorm = 1e-150;  // of a column: its square does not underflow
constexpr double kRidge = 1e-12;           // dependent columns share their coefficient

std::span<double> numbers(Eigen::MatrixXd& m, Eigen::Index column) {
    return {m.col(column).data(), static_cast<std::size_t>(m.rows())};
}
std::span<const double> numbers(const Eigen::MatrixXd& m, Eigen::Index column) {
    return {m.col(column).data(), static_cast<std::size_t>(m.rows())};
}
std::span<double> numbers(Eigen::VectorXd& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }
std::span<const double> numbers(const Eigen::VectorXd& v) { return {v.data(), static_cast<std::size_t>(v.size())}; }

/// Stores the part of the column outside the first k basis vectors as the next one, not yet of length 1, and returns
/// its length. Repeats once if little is left (Giraud, Langou, Rozloznik 2005).
double orthogonalise(std::span<const double> column, double length, Eigen::Index k, Eigen::MatrixXd& basis,
                     Eigen::MatrixXd& R) {
    const std::span<double> q = numbers(basis, k);
    if (k == 0) {
        std::ranges::copy(column, q.begin());
        return length;
    }
    std::span<const double> left = column;
    double rest = length;
    for (int pass = 0; pass < 2; ++pass) {
        for (Eigen::Index i = 0; i < k; ++i) {
            const double part = sum_of_products(numbers(basis, i), left);
            R(i, k) += part;
            rest = std::sqrt(add_multiple(left, -part, numbers(basis, i), q));
            left = q;
        }
        if (rest > kMinShareWithoutRepeat * length) break;
    }
    return rest;
}

}  // namespace

double square_of(const Eigen::VectorXd& y) { return sum_of_products(numbers(y), numbers(y)); }

// Gram-Schmidt; the first column is processed last, so that its independence of the others is checked.
void project_on(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y, double y_square, Projection& result) {
    const Eigen::Index m = columns.cols();
    result.basis.resize(columns.rows(), m);
    result.linear = Eigen::VectorXd::Zero(m);
    result.determined = true;
    result.residual = y;
    result.sse = y_square;
    Eigen::MatrixXd R = Eigen::MatrixXd::Zero(m, m);
    Eigen::VectorXd coordinates = Eigen::VectorXd::Zero(m);
    for (Eigen::Index k = 0; k < m; ++k) {
        const std::span<const double> column = numbers(columns, m - 1 - k);
        const std::span<double> q = numbers(result.basis, k), residual = numbers(result.residual);
        const double length = length_of(column);
        const double rest = orthogonalise(column, length, k, result.basis, R);
        if (!(rest > kMinIndependentShare * length) || rest < kMinColumnNorm) {
            if (k == m - 1) result.determined = false;
            R(k, k) = 1;
            std::ranges::fill(q, 0.0);
            continue;
        }
        R(k, k) = rest;
        result.basis.col(k) *= 1 / rest;
        coordinates[k] = sum_of_products(q, residual);
        result.sse = add_multiple(residual, -coordinates[k], q, residual);
    }
    const Eigen::VectorXd solution = R.triangularView<Eigen::Upper>().solve(coordinates);
    for (Eigen::Index k = 0; k < m; ++k) result.linear[m - 1 - k] = solution[k];
}

double rough_rest(const Eigen::MatrixXd& columns, const Eigen::VectorXd& y, double y_square) {
    const Eigen::Index m = columns.cols();
    FewByFew G(m, m);
    Few b(m);
    for (Eigen::Index k = 0; k < m; ++k) {
        b[k] = sum_of_products(numbers(columns, k), numbers(y));
        for (Eigen::Index i = 0; i <= k; ++i)
            G(i, k) = G(k, i) = sum_of_products(numbers(columns, i), numbers(columns, k));
        G(k, k) *= 1 + kRidge;
    }
    return y_square - b.dot(solve_symmetric(G, b));
}

void take_out(const Eigen::MatrixXd& basis, Eigen::MatrixXd& D) {
    for (Eigen::Index k = 0; k < D.cols(); ++k)
        for (Eigen::Index i = 0; i < basis.cols(); ++i) {
            const double part = sum_of_products(numbers(basis, i), numbers(D, k));
            add_multiple(numbers(D, k), -part, numbers(basis, i), numbers(D, k));
        }
}

NormalEquations normal_equations(const Eigen::MatrixXd& D, const Eigen::VectorXd& e) {
    const Eigen::Index m = D.cols();
    NormalEquations equations{Eigen::MatrixXd(m, m), Eigen::VectorXd(m)};
    for (Eigen::Index k = 0; k < m; ++k) {
        equations.right[k] = sum_of_products(numbers(D, k), numbers(e));
        for (Eigen::Index i = 0; i <= k; ++i)
            equations.matrix(i, k) = equations.matrix(k, i) = sum_of_products(numbers(D, i), numbers(D, k));
    }
    return equations;
}

}  // namespace tunewright
