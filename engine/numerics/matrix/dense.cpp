#include "engine/numerics/matrix/dense.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>
#include <numbers>

namespace tunewright {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd gram(const Eigen::Ref<const MatrixXd>& A, const Eigen::Ref<const MatrixXd>& B) { return A.transpose() * B; }

VectorXd transpose_times(const Eigen::Ref<const MatrixXd>& A, const Eigen::Ref<const VectorXd>& b) {
    return A.transpose() * b;
}

VectorXd solve_symmetric(const MatrixXd& A, const VectorXd& b) { return A.ldlt().solve(b); }

Few solve_symmetric(const FewByFew& A, const Few& b) { return A.ldlt().solve(b); }

VectorXd solve_square(const MatrixXd& A, const VectorXd& b) { return A.fullPivLu().solve(b); }

// Column by column, here and below: with Eigen's forms for many columns at once the compile takes 1.5 times as long.
MatrixXd inverse_of(const MatrixXd& A) {
    const Eigen::FullPivLU<MatrixXd> lu(A);
    MatrixXd inverse(A.rows(), A.cols());
    for (Eigen::Index k = 0; k < A.cols(); ++k) inverse.col(k) = lu.solve(VectorXd(VectorXd::Unit(A.rows(), k)));
    return inverse;
}

VectorXd least_squares(const MatrixXd& A, const VectorXd& b) { return A.colPivHouseholderQr().solve(b); }

Reflected reflected(const MatrixXd& A, const MatrixXd& B) {
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(A);
    Reflected result{B, qr.matrixQR().diagonal()};
    for (Eigen::Index k = 0; k < B.cols(); ++k) {
        VectorXd column = B.col(k);
        column.applyOnTheLeft(qr.householderQ().adjoint());
        result.B.col(k) = column;
    }
    return result;
}

MatrixXd chebyshev_differentiation(int N, double L) {
    VectorXd x(N + 1);
    for (int i = 0; i <= N; ++i) x[i] = 0.5 * L * (std::cos(std::numbers::pi * i / N) - 1);
    const auto weight = [N](int i) { return (i == 0 || i == N ? 2.0 : 1.0) * (i % 2 == 0 ? 1 : -1); };
    MatrixXd D(N + 1, N + 1);
    for (int i = 0; i <= N; ++i) {
        double diagonal = 0;
        for (int j = 0; j <= N; ++j) {
            if (i == j) continue;
            D(i, j) = weight(i) / weight(j) / (x[i] - x[j]);
            diagonal -= D(i, j);
        }
        D(i, i) = diagonal;
    }
    return D;
}

}  // namespace tunewright
