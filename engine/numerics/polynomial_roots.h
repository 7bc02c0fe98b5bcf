// Roots of a real polynomial, simple and multiple ones.
//
//   polynomial_roots(std::vector<double>{1, 3, 2});      // s^2 + 3 s + 2: -1 and -2
//   polynomial_roots(std::vector<double>{1, 3, 3, 1});   // (s + 1)^3: three times -1 exactly
//   polynomial_roots(std::vector<double>{1, 0, 4});      // s^2 + 4: 2j, then -2j
#pragma once

#include <complex>
#include <span>
#include <vector>

namespace tunewright {

/// All roots of c[0] s^n + c[1] s^(n-1) + ... + c[n], c[0] != 0, as many as the degree n: each real one with an
/// imaginary part of exactly 0, complex ones in exact conjugate pairs, neighbours in the list, positive imaginary part
/// first. Otherwise the order is unspecified. Empty for n = 0, and if a quotient of coefficients overflows.
///
/// Eigenvalues of the scaled, balanced companion matrix, so O(n^3); then Newton steps as long as they lower the
/// residual. The error of a simple root is rounding times its condition number.
///
/// Multiple roots: rounding of the coefficients splits an m-fold root over about eps^(1/m) of itself, 2e-4 for m = 4. A
/// group of roots that close is replaced by one point, its centre as a simple root of the (m - 1)th derivative, if the
/// resulting polynomial equals the given one to the rounding of its coefficients: 1/(s + 1)^8 has one pole of order 8,
/// while roots that the coefficients do distinguish stay separate.
std::vector<std::complex<double>> polynomial_roots(std::span<const double> coefficients);

}  // namespace tunewright
