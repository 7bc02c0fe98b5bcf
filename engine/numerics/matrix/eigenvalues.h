// Eigenvalues of small dense matrices, as plain functions: Eigen's
// solvers are compiled once, behind this header. Matrices are n x n, row by row. Those of a symmetric one: dense.h.
#pragma once

#include <complex>
#include <span>
#include <vector>

namespace tunewright {

/// Eigenvalues of a real matrix after balancing; complex ones in exact conjugate pairs, positive imaginary part first.
/// Empty if an entry is not finite.
std::vector<std::complex<double>> eigenvalues(std::span<const double> matrix, int n);

/// Largest row sum of absolute values after balancing by a diagonal similarity, which makes it nearly as small as
/// possible: an upper bound of the rates of x' = M x that does not depend on the units of the states. States without
/// feedback (nothing depends on them, or they depend on nothing) do not count; 0 for a nilpotent chain of them.
double balanced_norm(std::span<const double> matrix, int n);

}  // namespace tunewright
