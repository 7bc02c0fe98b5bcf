// Sums over vectors of thousands of numbers, as least squares over a record takes them by the hundred, in the widest
// registers that a processor has.
//
//   const double part = sum_of_products(q, y);         // of y along q, of length 1
//   const double left = add_multiple(y, -part, q, y);  // what is left of y, and its square
//
// A sum goes in sixteen parts, number i in part i modulo 16, and these are added in pairs: its rounding is that of n/16
// additions one after the other, and both kinds of registers give equal results.
#pragma once

#include <cmath>
#include <span>

#include "engine/numerics/registers.h"

namespace tunewright {

/// The sum of a_i b_i over vectors of equal lengths; 0 for empty ones.
double sum_of_products(std::span<const double> a, std::span<const double> b, Registers registers = widest_registers());

/// The square root of the sum of squares: the length of x, as long as no square is beyond the range of numbers (x_i
/// beyond 1e154 or all below 1e-154).
inline double length_of(std::span<const double> x) { return std::sqrt(sum_of_products(x, x)); }

/// to := x + weight y, all of equal lengths, and the sum of squares of what comes out: another pass over thousands of
/// numbers would cost as much again. `to` may be x.
double add_multiple(std::span<const double> x, double weight, std::span<const double> y, std::span<double> to,
                    Registers registers = widest_registers());

}  // namespace tunewright
