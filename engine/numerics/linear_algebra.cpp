#include "engine/numerics/linear_algebra.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <unsupported/Eigen/MatrixFunctions>

namespace tunewright {
namespace {

using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Complex = std::complex<double>;

constexpr double kWorthScaling =
    0.95;  // of the norms: balancing stops where it lowers them by less (Parlett and Reinsch)
constexpr double kNoMarkovParameter = 1e-12;  // of the sum of its absolute terms: below it the parameter is rounding
constexpr double kRealZero = 1e-14;           // of a zero's size: below it its imaginary part is rounding

Matrix as_matrix(std::span<const double> values, int n) { return Eigen::Map<const Matrix>(values.data(), n, n); }

// Diagonal similarity by powers of two that makes row and column norms alike (Osborne 1960; Parlett and Reinsch 1969).
// A few sweeps do in practice; numbers at the ends of the range may never come to an end.
void balance(Matrix& A) {
    constexpr int kMaxSweeps = 100;
    const auto n = A.rows();
    bool changed = true;
    for (int sweep = 0; changed && sweep < kMaxSweeps; ++sweep) {
        changed = false;
        for (Eigen::Index i = 0; i < n; ++i) {
            double row = A.row(i).cwiseAbs().sum() - std::abs(A(i, i));
            double column = A.col(i).cwiseAbs().sum() - std::abs(A(i, i));
            if (row == 0 || column == 0) continue;
            const double sum = row + column;
            if (!std::isfinite(4 * sum)) return;
            double factor = 1;
            for (; column < row / 2; column *= 4) factor *= 2;
            for (; column >= row * 2; column /= 4) factor /= 2;
            if ((column + row) / factor < kWorthScaling * sum && factor != 1) {
                changed = true;
                A.row(i) /= factor;
                A.col(i) *= factor;
            }
        }
    }
}

// Conjugate pairs as neighbours with exactly conjugate values, real ones with exactly zero imaginary part.
std::vector<Complex> paired(const Eigen::VectorXcd& values) {
    std::vector<Complex> result;
    for (Eigen::Index i = 0; i < values.size(); ++i) {
        const Complex value = values[i];
        if (value.imag() == 0) {
            result.push_back(value);
        } else if (value.imag() > 0) {
            result.push_back(value);
            result.push_back(std::conj(value));
        }
    }
    return result;
}

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

std::vector<double> product(std::span<const double> A, std::span<const double> B, int n) {
    std::vector<double> result(A.size());
    Eigen::Map<Matrix>(result.data(), n, n).noalias() =
        Eigen::Map<const Matrix>(A.data(), n, n) * Eigen::Map<const Matrix>(B.data(), n, n);
    return result;
}

std::vector<Complex> eigenvalues(std::span<const double> matrix, int n) {
    if (n == 0) return {};
    Matrix A = as_matrix(matrix, n);
    if (!A.allFinite()) return {};
    balance(A);
    return paired(Eigen::EigenSolver<Matrix>(A, false).eigenvalues());
}

std::optional<std::vector<Complex>> transmission_zeros(std::span<const double> A, std::span<const double> B,
                                                       std::span<const double> C, double D, int n) {
    // The relative degree is that of the first Markov parameter that is not rounding.
    const Matrix a = as_matrix(A, n);
    const Eigen::VectorXd b = Eigen::Map<const Eigen::VectorXd>(B.data(), n);
    const Eigen::VectorXd c = Eigen::Map<const Eigen::VectorXd>(C.data(), n);
    int relative_degree = 0;
    if (D == 0) {
        Eigen::VectorXd power = b, magnitude = b.cwiseAbs();
        for (relative_degree = 1; relative_degree <= n; ++relative_degree) {
            if (std::abs(c.dot(power)) > kNoMarkovParameter * c.cwiseAbs().dot(magnitude)) break;
            power = a * power;
            magnitude = a.cwiseAbs() * magnitude;
        }
        if (relative_degree > n) return std::nullopt;
    }
    if (relative_degree == n) return std::vector<Complex>{};

    const double b_scale = std::max(b.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
    const double c_scale = std::max(c.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
    const double a_scale = std::max(a.cwiseAbs().maxCoeff(), std::numeric_limits<double>::min());
    Matrix pencil = Matrix::Zero(n + 1, n + 1), descriptor = Matrix::Zero(n + 1, n + 1);
    pencil.topLeftCorner(n, n) = a / a_scale;
    pencil.topRightCorner(n, 1) = b / b_scale;
    pencil.bottomLeftCorner(1, n) = c.transpose() / c_scale;
    pencil(n, n) = D * a_scale / (b_scale * c_scale);
    descriptor.topLeftCorner(n, n).setIdentity();
    const Eigen::GeneralizedEigenSolver<Eigen::MatrixXd> solver(pencil, descriptor, false);
    std::vector<Complex> finite;
    for (Eigen::Index i = 0; i <= n; ++i)
        if (solver.betas()[i] != 0) finite.push_back(solver.alphas()[i] / solver.betas()[i] * a_scale);
    // Infinite eigenvalues come out huge rather than infinite: as many as there are zeros are kept, the smallest.
    std::sort(finite.begin(), finite.end(), [](Complex x, Complex y) { return std::abs(x) < std::abs(y); });
    if (static_cast<int>(finite.size()) > n - relative_degree)
        finite.resize(static_cast<std::size_t>(n - relative_degree));
    std::vector<Complex> result;
    for (const Complex zero : finite) {
        if (std::abs(zero.imag()) <= kRealZero * std::abs(zero)) {
            result.emplace_back(zero.real());
        } else if (zero.imag() > 0) {
            result.push_back(zero);
            result.push_back(std::conj(zero));
        }
    }
    return result;
}

Complex resolvent_response(std::span<const double> A, std::span<const double> B, std::span<const double> C, double D,
                           int n, Complex s) {
    if (n == 0) return D;
    const Eigen::VectorXd b = Eigen::Map<const Eigen::VectorXd>(B.data(), n);
    const Eigen::VectorXd c = Eigen::Map<const Eigen::VectorXd>(C.data(), n);
    Eigen::MatrixXcd pencil = (-as_matrix(A, n)).cast<Complex>();
    pencil.diagonal().array() += s;
    const Eigen::VectorXcd x = pencil.partialPivLu().solve(b.cast<Complex>());
    return c.cast<Complex>().dot(x) + D;
}

SymmetricEigen symmetric_eigen(std::span<const double> matrix, int n) {
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(as_matrix(matrix, n));
    SymmetricEigen result;
    for (Eigen::Index k = 0; k < n; ++k) {
        result.values.push_back(solver.eigenvalues()(k));
        const Eigen::VectorXd vector = solver.eigenvectors().col(k);
        result.vectors.emplace_back(vector.data(), vector.data() + n);
    }
    return result;
}

double balanced_norm(std::span<const double> matrix, int n) {
    Matrix A = as_matrix(matrix, n);
    // A state without a way out or in can be given any unit: its couplings vanish, and with them those of the next.
    bool removed = true;
    while (removed) {
        removed = false;
        for (Eigen::Index i = 0; i < n; ++i) {
            const double own = std::abs(A(i, i)), row = A.row(i).cwiseAbs().sum() - own,
                         column = A.col(i).cwiseAbs().sum() - own;
            if ((row > 0) == (column > 0)) continue;
            A.row(i).setZero();
            A.col(i).setZero();
            A(i, i) = own;
            removed = true;
        }
    }
    balance(A);
    return n > 0 ? A.cwiseAbs().rowwise().sum().maxCoeff() : 0;
}

std::vector<double> matrix_exponential(std::span<const double> matrix, int n) {
    const Matrix result = as_matrix(matrix, n).exp();
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
    Eigen::JacobiSVD<Matrix> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
    svd.setThreshold(cutoff);
    const Eigen::VectorXd x = svd.solve(Eigen::Map<const Eigen::VectorXd>(b.data(), n));
    return {x.data(), x.data() + n};
}

namespace {

using Index = std::size_t;

constexpr double kNever = 1e9;  // the cost of a zero

/// Rows join one by one along the shortest alternating path. Column n stands for "none yet".
class Assignment {
public:
    Assignment(std::span<const double> matrix, Index n)
        : n_(n), rows_(n, 0.0), columns_(n + 1, 0.0), row_of_(n + 1, n) {
        for (const double entry : matrix) cost_.push_back(entry == 0 ? kNever : -std::log2(std::abs(entry)));
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
            if (step > kNever / 2) return false;
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
    std::vector<Index> row_of_;                  // of each column
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
