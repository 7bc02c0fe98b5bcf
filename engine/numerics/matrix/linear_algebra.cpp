#include "engine/numerics/matrix/linear_algebra.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>
#include <cstddef>
#include <limits>
#include <unsupported/Eigen/MatrixFunctions>

namespace tunewright {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Matrix as_matrix(std::span<const double> values, int n) { return Eigen::Map<const Matrix>(values.data(), n, n); }

}  // namespace

std::vector<double> row_by_row(const std::vector<std::vector<double>>& rows) {
    std::vector<double> matrix;
    for (const auto& row : rows) matrix.insert(matrix.end(), row.begin(), row.end());
    return matrix;
}

std::vector<double> row_times(std::span<const double> a, std::span<const double> A) {
    const auto n = static_cast<Eigen::Index>(a.size());
    std::vector<double> row(a.size());
    Eigen::Map<Eigen::RowVectorXd>(row.data(), n) =
        Eigen::Map<const Eigen::RowVectorXd>(a.data(), n) * Eigen::Map<const Matrix>(A.data(), n, n);
    return row;
}

std::vector<double> matrix_product(std::span<const double> A, std::span<const double> B, int n) {
    std::vector<double> result(A.size());
    Eigen::Map<Matrix>(result.data(), n, n).noalias() =
        Eigen::Map<const Matrix>(A.data(), n, n) * Eigen::Map<const Matrix>(B.data(), n, n);
    return result;
}

namespace {

constexpr double kMaxUnscaledNorm = 5;  // norm of a matrix: up to it the exponential is a fraction without squaring
constexpr int kMaxSweeps = 20;

double power_of_two(double x) { return std::exp2(std::round(std::log2(x))); }

/// Units of the states, powers of two, that make row and column norms nearly equal (Osborne 1960). A state on which
/// nothing depends, or that depends on nothing, has a unit in which its row or column is at most 1.
Eigen::VectorXd alike(Matrix& A) {
    Eigen::VectorXd units = Eigen::VectorXd::Ones(A.rows());
    bool changed = true;
    for (int sweep = 0; sweep < kMaxSweeps && changed; ++sweep) {
        changed = false;
        for (Eigen::Index i = 0; i < A.rows(); ++i) {
            const double own = std::abs(A(i, i)), row = A.row(i).lpNorm<1>() - own, column = A.col(i).lpNorm<1>() - own;
            double unit = 1;
            if (row > 0 && column > 0)
                unit = power_of_two(std::sqrt(row) / std::sqrt(column));
            else if (row > 1)
                unit = power_of_two(row);
            else if (column > 1)
                unit = power_of_two(1 / column);
            if (unit == 1 || !std::isfinite(unit) || unit == 0) continue;
            A.row(i) /= unit;
            A.col(i) *= unit;
            units[i] *= unit;
            changed = true;
        }
    }
    return units;
}

}  // namespace

std::vector<double> matrix_exponential(std::span<const double> matrix, int n) {
    if (n == 1) return {std::exp(matrix[0])};
    Matrix A = as_matrix(matrix, n);
    if (!(A.cwiseAbs().colwise().sum().maxCoeff() > kMaxUnscaledNorm)) {
        const Matrix result = A.exp();
        return {result.data(), result.data() + result.size()};
    }
    // The largest entry may be large only because of its unit: squaring as often as it requires would lose as many
    // digits.
    const Eigen::VectorXd units = alike(A);
    const Matrix result = units.asDiagonal() * Matrix(A.exp()) * units.cwiseInverse().asDiagonal();
    return {result.data(), result.data() + result.size()};
}

std::optional<std::vector<double>> solve(std::span<const double> matrix, std::span<const double> b, int n) {
    const auto scaling = scaling_of(matrix, n);
    if (!scaling) return std::nullopt;
    const auto rows = Eigen::Map<const Eigen::VectorXd>(scaling->rows.data(), n),
               columns = Eigen::Map<const Eigen::VectorXd>(scaling->columns.data(), n);
    const Eigen::FullPivLU<Matrix> lu(Matrix(rows.asDiagonal() * as_matrix(matrix, n) * columns.asDiagonal()));
    if (!lu.isInvertible()) return std::nullopt;
    const Eigen::VectorXd right = rows.cwiseProduct(Eigen::Map<const Eigen::VectorXd>(b.data(), n));
    const Eigen::VectorXd x = columns.cwiseProduct(Eigen::VectorXd(lu.solve(right)));
    return std::vector<double>(x.data(), x.data() + x.size());
}

std::vector<double> least_norm_solution(std::span<const double> matrix, std::span<const double> b, int n,
                                        double cutoff) {
    const Matrix M = as_matrix(matrix, n);
    Eigen::JacobiSVD<Matrix, Eigen::NoQRPreconditioner> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
    svd.setThreshold(cutoff);
    const Eigen::VectorXd x = svd.solve(Eigen::Map<const Eigen::VectorXd>(b.data(), n));
    return {x.data(), x.data() + n};
}

namespace {

using Index = std::size_t;

constexpr double kCostOfZero = 1e9;  // cost of a zero entry

/// Rows are added one by one along the shortest alternating path. Column n stands for "none yet".
class Assignment {
public:
    Assignment(std::span<const double> matrix, Index n)
        : n_(n), rows_(n, 0.0), columns_(n + 1, 0.0), row_of_(n + 1, n) {
        for (const double entry : matrix) cost_.push_back(entry == 0 ? kCostOfZero : -std::log2(std::abs(entry)));
    }

    bool solve() {
        for (Index row = 0; row < n_; ++row)
            if (!join(row)) return false;
        return true;
    }

    MatrixScaling scaling() const {
        MatrixScaling scaling;
        for (Index i = 0; i < n_; ++i) {
            scaling.rows.push_back(std::ldexp(1.0, static_cast<int>(std::lround(rows_[i]))));
            scaling.columns.push_back(std::ldexp(1.0, static_cast<int>(std::lround(columns_[i]))));
        }
        return scaling;
    }

private:
    bool join(Index row) {
        distance_.assign(n_, std::numeric_limits<double>::infinity());
        before_.assign(n_, n_);
        used_.assign(n_ + 1, false);
        Index at = n_;
        row_of_[n_] = row;
        while (row_of_[at] < n_) {
            used_[at] = true;
            const Index next = nearest(at);
            const double step = distance_[next];
            if (step > kCostOfZero / 2) return false;
            raise(step);
            at = next;
        }
        for (; at < n_; at = before_[at]) row_of_[at] = row_of_[before_[at]];
        row_of_[n_] = n_;
        return true;
    }

    Index nearest(Index at) {
        const Index i = row_of_[at];
        Index next = n_;
        for (Index j = 0; j < n_; ++j) {
            if (used_[j]) continue;
            const double reduced = cost_[i * n_ + j] - rows_[i] - columns_[j];
            if (reduced < distance_[j]) {
                distance_[j] = reduced;
                before_[j] = at;
            }
            if (next == n_ || distance_[j] < distance_[next]) next = j;
        }
        return next;
    }

    void raise(double step) {
        for (Index j = 0; j <= n_; ++j) {
            if (used_[j]) {
                rows_[row_of_[j]] += step;
                columns_[j] -= step;
            } else if (j < n_) {
                distance_[j] -= step;
            }
        }
    }

    Index n_;
    std::vector<double> cost_, rows_, columns_;  // costs; potentials, cost - row - column >= 0
    std::vector<Index> row_of_;                  // row of each column
    std::vector<double> distance_;
    std::vector<Index> before_;
    std::vector<bool> used_;
};

}  // namespace

std::optional<MatrixScaling> scaling_of(std::span<const double> matrix, int n) {
    Assignment assignment(matrix, Index(n));
    if (!assignment.solve()) return std::nullopt;
    return assignment.scaling();
}

}  // namespace tunewright
