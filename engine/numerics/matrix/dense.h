// Products, decompositions and solutions of dense matrices of any size, each compiled once behind this header, because
// Eigen's templates take most of the compile time of a source that uses them. Small systems without Eigen's types:
// linear_algebra.h. Eigenvalues of any matrix: eigenvalues.h.
//
//   x = solve_symmetric(gram(J, J), transpose_times(J, e));   // least squares by normal equations
#pragma once

#include <Eigen/Core>

namespace tunewright {

/// A' B for A of n x m and B of n x k.
Eigen::MatrixXd gram(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::MatrixXd>& B);

/// A' b for A of n x m.
Eigen::VectorXd transpose_times(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::VectorXd>& b);

/// Solves A x = b for A symmetric and positive semidefinite (LDL' with pivoting); only the lower triangle is read.
Eigen::VectorXd solve_symmetric(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// The same up to this size, without any allocation.
inline constexpr int kMaxSmallSize = 8;
using FewByFew = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMaxSmallSize, kMaxSmallSize>;
using Few = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMaxSmallSize, 1>;
Few solve_symmetric(const FewByFew& A, const Few& b);

/// Solves A x = b for any square A (LU with full pivoting); if A is singular, an x with the least residual.
Eigen::VectorXd solve_square(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// A^-1 by the same decomposition; not finite if A is singular.
Eigen::MatrixXd inverse_of(const Eigen::MatrixXd& A);

/// The x with the least |A x - b| (QR with column pivoting): dependent columns get 0.
Eigen::VectorXd least_squares(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// A P = Q R for A of n x m, n >= m, its columns in the order P. Contains Q' B, whose last n - m rows are the part that
/// no combination of A's columns reaches, and the diagonal of R.
struct Reflected {
    Eigen::MatrixXd B;
    Eigen::VectorXd diagonal;
};
Reflected reflected(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

/// Eigenvalues in ascending order, eigenvectors in columns of length 1.
struct PrincipalAxes {
    Eigen::VectorXd values;
    Eigen::MatrixXd vectors;
};
/// For a symmetric matrix; only the lower triangle is read. Implemented in eigenvalues.cpp with the other eigenvalue
/// solver: in dense.cpp the compile would need more than 0.7 GB.
PrincipalAxes principal_axes(const Eigen::MatrixXd& A);

/// The matrix that takes a function's values at the Chebyshev nodes theta_i = L (cos(pi i/N) - 1)/2, from 0 down to -L,
/// to its derivative there; (N + 1) x (N + 1) (Trefethen 2000, Spectral Methods in MATLAB, chapter 6).
Eigen::MatrixXd chebyshev_differentiation(int N, double L);

}  // namespace tunewright
