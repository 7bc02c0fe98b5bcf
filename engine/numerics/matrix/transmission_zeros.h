// Zeros of a state space. In its own source, because Eigen's generalised solver takes as long to compile as all others.
#pragma once

#include <complex>
#include <optional>
#include <span>
#include <vector>

namespace tunewright {

/// Finite zeros of C (sI - A)^-1 B + D: generalised eigenvalues of the system pencil. Empty optional: the transfer
/// function is 0. A is n x n, row by row; B and C have n numbers. Complex zeros come in exact conjugate pairs, positive
/// imaginary part first.
std::optional<std::vector<std::complex<double>>> transmission_zeros(std::span<const double> A,
                                                                    std::span<const double> B,
                                                                    std::span<const double> C, double D, int n);

}  // namespace tunewright
