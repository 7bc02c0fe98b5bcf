// Matrices whose columns are each padded with zeros to a whole number of registers, so that combinations of columns
// need only products and sums of registers. The steps of a linear system consist of such combinations.
//
// Both kinds of registers add in the same order: their results are equal.
#pragma once

#include <cstddef>
#include <span>

#include "engine/numerics/registers.h"

namespace tunewright {

/// The length of a column of n numbers.
constexpr std::size_t column_length(std::size_t n) { return (n + 3) / 4 * 4; }

/// A product of matrices: to_k := factor times the combination of n columns with the first n numbers of weights_k, for
/// k < count.
struct ColumnProduct {
    const double* columns;
    std::size_t length;  ///< length of a column, a multiple of four
    std::size_t n;
    const double* weights;
    std::size_t weights_apart;  ///< distance from weights_k to the next
    std::size_t count;
    double factor = 1;
    double* to;  ///< may be `weights`: then each result replaces its weights
    std::size_t to_apart;
};
void multiply_columns(const ColumnProduct& product, Registers registers = widest_registers());

/// z := sum of the n columns, each times its weight in z, then the sum of the columns of the inputs. z has n numbers.
void map_columns(const double* columns, std::size_t n, std::span<double> z, std::span<const double> inputs,
                 Registers registers = widest_registers());

/// to += weight times from, for that many whole columns. False: no number of `to` changed by more than 1e-18 of itself.
bool add_columns(double* to, const double* from, std::size_t count, double weight,
                 Registers registers = widest_registers());

}  // namespace tunewright
