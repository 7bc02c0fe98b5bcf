// Sums over vectors of thousands of numbers in the widest registers of the processor. Least squares over a record need
// hundreds of them.
//
//   const double part = sum_of_products(q, y);         // of y along q, of length 1
//   const double left = add_multiple(y, -part, q, y);  // what is left of y, and its square
//
// A sum is computed in sixteen parts, number i in part i modulo 16, and these are added in pairs: its rounding is that
// of n/16 successive additions, and both kinds of registers give equal results.
#pragma once

#include <cmath>
#include <span>

#include "engine/numerics/registers.h"

namespace tunewright {

/// The sum of a_i b_i over vectors of equal lengths; 0 for empty ones.
double sum_of_products(std::span<const double> a, std::span<const double> b, Registers registers = widest_registers());

/// The square root of the sum of squares: the length of x, if no square is out of the number range (x_i beyond 1e154 or
/// all below 1e-154).
inline double length_of(std::span<const double> x) { return std::sqrt(sum_of_products(x, x)); }

/// to := x + weight y, all of equal lengths. Returns the sum of squares of the result, because another pass over
/// thousands of numbers would double the cost. `to` may be x.
double add_multiple(std::span<const double> x, double weight, std::span<const double> y, std::span<double> to,
                    Registers registers = widest_registers());

}  // namespace tunewright
