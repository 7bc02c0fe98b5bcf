// Roots that a polynomial has more than once.
#pragma once

#include <complex>
#include <span>
#include <vector>

namespace tunewright {

/// Rounding of coefficients tears an m-fold root apart to about eps^(1/m) of itself, differently for every scale of s.
/// Groups of roots that close are put on one point, their centre as a root of the (m - 1)th derivative, where the
/// polynomial of the roots so changed is the given one to the rounding of its coefficients; others stay as they are.
/// `coefficients`: descending powers, leading one not 0; `roots`: conjugate pairs as neighbours, all of them.
void merge_multiple_roots(std::span<const double> coefficients, std::vector<std::complex<double>>& roots);

}  // namespace tunewright
