// Convex quadratic programs: minimise g'x + x'Hx/2 subject to A x <= b.
//
//   SmallProgram program(2, 3);                  // two unknowns, room for three constraints
//   program.H = ...; program.g = ...;
//   program.add(Eigen::Vector2d(1, 1), 0.5);     // x1 + x2 <= 0.5
//   if (const auto minimum = solve(program)) use(minimum->x, minimum->multipliers);
#pragma once

#include <Eigen/Core>
#include <optional>

namespace tunewright::optimise {

/// N and M are the maximal numbers of unknowns and constraints, so that nothing is allocated; Eigen::Dynamic: no
/// maximum, on the heap.
template <int N, int M>
struct QuadraticProgram {
    using Vector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, N, 1>;
    using Matrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, N, N>;
    using Normals = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, N, M>;
    using Bounds = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, M, 1>;

    /// The objective x'x/2 with `unknowns` entries and no constraints; `capacity` is the maximal number of constraints.
    QuadraticProgram(Eigen::Index unknowns, Eigen::Index capacity)
        : H(Matrix::Identity(unknowns, unknowns)), g(Vector::Zero(unknowns)), A(unknowns, capacity), b(capacity) {}

    /// Adds normal'x <= bound; `normal` has as many entries as there are unknowns.
    template <class Derived>
    void add(const Eigen::MatrixBase<Derived>& normal, double bound) {
        A.col(constraints) = normal;
        b[constraints++] = bound;
    }

    Matrix H;   ///< n x n, symmetric, positive definite
    Vector g;   ///< n
    Normals A;  ///< transposed: n x capacity, each of the first `constraints` columns is the normal of a constraint
    Bounds b;   ///< capacity
    Eigen::Index constraints = 0;
};

template <int N, int M>
struct QuadraticMinimum {
    typename QuadraticProgram<N, M>::Vector x;            ///< n
    typename QuadraticProgram<N, M>::Bounds multipliers;  ///< one for each constraint, >= 0; 0 for an inactive one
};

/// The minimum. Active constraints hold to rounding, the others to 1e-9, relative to b where |b| > 1.
///
/// Empty: no x meets all constraints, or H is not positive definite. Cost: a factorisation of H, then O(n (n + m)) for
/// each constraint that joins or leaves the active set; two to five changes are usual with up to four unknowns.
template <int N, int M>
std::optional<QuadraticMinimum<N, M>> solve(const QuadraticProgram<N, M>& program);

/// For up to four unknowns (the parameters of a PID and its filter) and 14 constraints: without the heap.
using SmallProgram = QuadraticProgram<4, 14>;
/// For any size: some tens of unknowns and some hundreds of constraints take a millisecond.
using LargeProgram = QuadraticProgram<Eigen::Dynamic, Eigen::Dynamic>;

extern template std::optional<QuadraticMinimum<4, 14>> solve(const SmallProgram&);
extern template std::optional<QuadraticMinimum<Eigen::Dynamic, Eigen::Dynamic>> solve(const LargeProgram&);

}  // namespace tunewright::optimise
