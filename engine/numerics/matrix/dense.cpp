#include "engine/numerics/matrix/dense.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/QR>

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

MatrixXd inverse_of(const MatrixXd& A) { return A.fullPivLu().inverse(); }

VectorXd least_squares(const MatrixXd& A, const VectorXd& b) { return A.colPivHouseholderQr().solve(b); }

Reflected reflected(const MatrixXd& A, const MatrixXd& B) {
    const Eigen::HouseholderQR<MatrixXd> qr(A);
    return {qr.householderQ().adjoint() * B, qr.matrixQR().diagonal()};
}

}  // namespace tunewright
