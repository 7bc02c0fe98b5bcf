// Products, exponentials and solutions of small dense systems as plain functions: Eigen's LU, SVD and exponential are
// compiled once, behind this header. Matrices are n x n, row by row. Eigenvalues: eigenvalues.h.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace tunewright {

/// Sum of a_i b_i over the entries of `a`. A plain loop: Eigen's version takes 0 to 10 % longer for up to 6 entries,
/// the usual number in loops.
inline double dot(std::span<const double> a, std::span<const double> b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return sum;
}

/// out = A x, `A` with n columns and as many rows as `out` has entries. A plain loop: Eigen's product takes 1.1 (n = 4)
/// to 1.6 (n = 2) times as long in its fastest form.
inline void multiply(std::span<const double> A, std::span<const double> x, std::span<double> out) {
    const std::size_t n = x.size();
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = dot(x, A.subspan(i * n, n));
}

/// a A for a row a of n numbers.
std::vector<double> row_times(std::span<const double> a, std::span<const double> A);

/// A B, both n x n.
std::vector<double> matrix_product(std::span<const double> A, std::span<const double> B, int n);

/// The rows of a matrix one after another.
std::vector<double> row_by_row(const std::vector<std::vector<double>>& rows);

/// exp(M), scaling and squaring with a Pade approximant (Higham 2005, as Eigen implements it).
std::vector<double> matrix_exponential(std::span<const double> matrix, int n);

/// Solves M x = b by LU with partial pivoting; empty if M is singular to working precision.
std::optional<std::vector<double>> solve(std::span<const double> matrix, std::span<const double> b, int n);

/// The shortest x with the smallest |M x - b|, singular values below `cutoff` times the largest taken as 0 (SVD).
std::vector<double> least_norm_solution(std::span<const double> matrix, std::span<const double> b, int n,
                                        double cutoff);

/// Factors of rows and columns, powers of two.
struct MatrixScaling {
    std::vector<double> rows, columns;
};

/// Scaling after which no entry is larger than about one, and those of the permutation with the largest product are
/// about one. The scaled matrix does not depend on the units of equations and unknowns, and entries that are only
/// rounding do not matter. Empty if every permutation contains a zero: the matrix is singular. `matrix`: n x n, row by
/// row. Source: Olschowka, Neumaier, Linear Algebra and its Applications 240 (1996) 131-151; the permutation is found
/// as an assignment (Kuhn 1955), whose potentials are the logarithms of the factors.
std::optional<MatrixScaling> scaling_of(std::span<const double> matrix, int n);

}  // namespace tunewright
