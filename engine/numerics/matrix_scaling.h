// Units of equations and unknowns in which a matrix shows what it is.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace tunewright {

/// Factors of rows and columns, powers of two.
struct MatrixScaling {
    std::vector<double> rows, columns;
};

/// After scaling no entry is above about one in size, and those of the permutation with the largest product are about
/// one: whatever units equations and unknowns had, the same matrix is left, and entries that are mere rounding do not
/// matter. Empty: every permutation holds a zero, the matrix is singular. `matrix`: n x n, row by row.
/// Source: Olschowka, Neumaier, Linear Algebra and its Applications 240 (1996) 131-151; the permutation is found as an
/// assignment (Kuhn 1955), whose potentials are the logarithms of the factors.
std::optional<MatrixScaling> scaling_of(std::span<const double> matrix, int n);

}  // namespace tunewright
