// The frequency response of a state space as plain functions. A is n x n, row by row; B and C have n numbers.
#pragma once

#include <complex>
#include <span>
#include <vector>

namespace tunewright {

/// C (sI - A)^-1 B + D by solving the linear system.
std::complex<double> resolvent_response(std::span<const double> A, std::span<const double> B, std::span<const double> C,
                                        double D, int n, std::complex<double> s);

/// C (sI - A)^-1 for a row C: entries are not finite where s is an eigenvalue.
std::vector<std::complex<double>> resolvent_row(std::span<const double> A, std::span<const double> C, int n,
                                                std::complex<double> s);

}  // namespace tunewright
