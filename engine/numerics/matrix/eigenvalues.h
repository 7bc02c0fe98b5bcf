// Eigenvalues of small dense matrices, and the zeros and the response of a state space, as plain functions: Eigen's
// solvers are compiled once, behind this header. Matrices are n x n, row by row. Those of a symmetric one: dense.h.
#pragma once

#include <complex>
#include <optional>
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

/// Finite zeros of C (sI - A)^-1 B + D: generalised eigenvalues of the system pencil. Empty optional: the transfer
/// function is 0. A is n x n, row by row; B and C have n numbers. Complex zeros come in exact conjugate pairs, positive
/// imaginary part first. In transmission_zeros.cpp, because Eigen's generalised solver takes as long to compile as all
/// of the others.
std::optional<std::vector<std::complex<double>>> transmission_zeros(std::span<const double> A,
                                                                    std::span<const double> B,
                                                                    std::span<const double> C, double D, int n);

/// C (sI - A)^-1 B + D by solving the linear system.
std::complex<double> resolvent_response(std::span<const double> A, std::span<const double> B, std::span<const double> C,
                                        double D, int n, std::complex<double> s);

/// C (sI - A)^-1 for a row C: entries are not finite where s is an eigenvalue.
std::vector<std::complex<double>> resolvent_row(std::span<const double> A, std::span<const double> C, int n,
                                                std::complex<double> s);

}  // namespace tunewright
