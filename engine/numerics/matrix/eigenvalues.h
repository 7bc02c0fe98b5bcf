// Eigenvalues of small dense matrices, as plain functions: Eigen's
// solvers are compiled once, behind this header. Matrices are n x n, row by row. Those of a symmetric one: dense.h.
#pragma once

#include <complex>
#include <span>
#include <vector>

namespace tunewright {

/// Eigenvalues of a real matrix after balancing; complex ones in exact conjugate pairs, positive imaginary part first.
/// None where an entry is not finite.
std::vector<std::complex<double>> eigenvalues(std::span<const double> matrix, int n);

/// Largest row sum of absolute values that a diagonal similarity leaves about as small as any (balancing): whatever
/// units the states of x' = M x have, a bound on the speed of what they do together. States that nothing comes back
/// from, or nothing goes to, do not count; 0 for a nilpotent chain of them.
double balanced_norm(std::span<const double> matrix, int n);

}  // namespace tunewright
