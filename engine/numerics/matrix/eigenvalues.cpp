#include "engine/numerics/matrix/eigenvalues.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/numerics/matrix/dense.h"

namespace tunewright {
namespace {

using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Matrix = Eigen::MatrixXd;  // column by column: the order of the solvers, a quarter faster
using Complex = std::complex<double>;

constexpr double kWorthScaling =
    0.95;  // of the norms: balancing ends when it lowers them by less (Parlett and Reinsch)

Matrix as_matrix(std::span<const double> values, int n) { return Eigen::Map<const Rows>(values.data(), n, n); }

// Diagonal similarity by powers of two that makes row and column norms nearly equal (Osborne 1960; Parlett and Reinsch
// 1969). A few sweeps are enough in practice; numbers at the ends of the range might never converge.
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

std::vector<Complex> eigenvalues(std::span<const double> matrix, int n) {
    if (n == 0) return {};
    Matrix A = as_matrix(matrix, n);
    if (!A.allFinite()) return {};
    balance(A);
    return paired(Eigen::EigenSolver<Matrix>(A, false).eigenvalues());
}

PrincipalAxes principal_axes(const Matrix& A) {
    const Eigen::SelfAdjointEigenSolver<Matrix> solver(A);
    return {solver.eigenvalues(), solver.eigenvectors()};
}

double balanced_norm(std::span<const double> matrix, int n) {
    Matrix A = as_matrix(matrix, n);
    // A state that does not affect others, or is not affected by others, can have any unit: its couplings vanish, and
    // with them perhaps those of the next.
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

}  // namespace tunewright
