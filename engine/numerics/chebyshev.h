// Differentiation on Chebyshev nodes.
#pragma once

#include <Eigen/Core>

namespace tunewright {

/// The matrix that takes a function's values at the nodes theta_i = L (cos(pi i/N) - 1)/2, from 0 down to -L, to its
/// derivative there; (N + 1) x (N + 1) (Trefethen 2000, Spectral Methods in MATLAB, chapter 6).
Eigen::MatrixXd chebyshev_differentiation(int N, double L);

}  // namespace tunewright
