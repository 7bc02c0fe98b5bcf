// The dual active-set method (Goldfarb and Idnani 1983, Mathematical Programming 27, 1-33). From the minimum without
// constraints:
//
//  1. H = L L'; J = L^-T and the empty triangle R. Throughout J' N = [R; 0], N the normals of the active constraints.
//  2. The most violated constraint is chosen to become active; if none is violated, the point is the minimum.
//  3. Two directions follow from d = J' n, n its normal: x moves along J2 d2, J2 the columns of J behind R, and the
//     multipliers of the active constraints along -R^-1 d1.
//  4. The step ends where the constraint holds, or earlier at the active constraint whose multiplier reaches 0 first;
//     if neither end exists, no x meets all constraints.
//  5. In the first case the constraint joins the active set; in the second that other one leaves it, and 3 follows.
//  6. x and the multipliers of the active set are recomputed from J and R (an addition to the published method):
//     with H = diag(.., 1e-6) the free minimum lies 1e7 or more away, and the rounding there would remain in the steps.
//
// The value rises with each constraint that joins, so that no active set occurs twice; `max_changes` stops a cycle
// through rounding.
#include "engine/numerics/optimise/quadratic_program.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tunewright::optimise {
namespace {

using Eigen::Index;

/// All values are rounding errors with a margin; none was found by trials.
struct ActiveSetConstants {
    double slack = 1e-9;        ///< of a constraint, absolute and relative to its b: a smaller violation counts as none
    double dependent = 1e-16;   ///< |d2|^2/|d|^2: a normal within 1e-8 rad of the span of the active ones
    double rounding = 1e-14;    ///< of the largest entry of the multipliers' direction: a smaller entry counts as 0
    int changes_per_size = 10;  ///< of the active set, times n + m; two to five are usual for n = 3, n + 5 for n = 30
};

template <int N, int M>
class DualActiveSet {
    using Program = QuadraticProgram<N, M>;
    using Vector = typename Program::Vector;
    using Matrix = typename Program::Matrix;

public:
    explicit DualActiveSet(const Program& program)
        : program_(program), n_(program.g.size()), R_(n_, n_), y_(n_), u_(n_), d_(n_), r_(n_), active_(n_) {}

    std::optional<QuadraticMinimum<N, M>> solve() {
        const Eigen::LLT<Matrix> factored(program_.H);
        if (factored.info() != Eigen::Success) return std::nullopt;
        J_ = factored.matrixU().solve(Matrix::Identity(n_, n_));
        move_to_minimum();
        for (int left = k_.changes_per_size * int(n_ + program_.constraints); left > 0; --left) {
            const Index next = max_exceeded();
            if (next < 0) return minimum();
            if (!activate(next, left)) return std::nullopt;
        }
        return std::nullopt;
    }

private:
    double excess(Index i) const { return program_.A.col(i).dot(x_) - program_.b[i]; }

    /// The most violated constraint; -1: none is violated.
    Index max_exceeded() const {
        Index max = -1;
        double largest = 0;
        for (Index i = 0; i < program_.constraints; ++i) {
            const double here = excess(i);
            if (here <= largest || here <= k_.slack * (1 + std::abs(program_.b[i])) || is_active(i)) continue;
            largest = here;
            max = i;
        }
        return max;
    }

    bool is_active(Index i) const { return std::find(active_.data(), active_.data() + q_, i) != active_.data() + q_; }

    /// False: no x meets the constraints, or `left` changes were not enough.
    bool activate(Index i, int& left) {
        for (; left > 0; --left) {
            d_.noalias() = J_.transpose() * -program_.A.col(i);
            r_.head(q_) = R_.topLeftCorner(q_, q_).template triangularView<Eigen::Upper>().solve(d_.head(q_));
            const double free = d_.tail(n_ - q_).squaredNorm();
            const bool moves = free > k_.dependent * d_.squaredNorm();
            const double full = moves ? std::max(0.0, excess(i)) / free : kInfinity;
            const auto [leaving, partial] = first_to_leave();
            const double step = std::min(full, partial);
            if (!(step < kInfinity)) return false;
            if (full <= partial) {
                join(i);
                move_to_minimum();
                return true;
            }
            if (moves) x_.noalias() += step * (J_.rightCols(n_ - q_) * d_.tail(n_ - q_));
            u_.head(q_) -= step * r_.head(q_);
            leave(leaving);
        }
        return false;
    }

    struct Leaving {
        Index at = -1;
        double step = kInfinity;
    };

    Leaving first_to_leave() const {
        Leaving first;
        const double min = q_ > 0 ? k_.rounding * r_.head(q_).cwiseAbs().maxCoeff() : 0;
        for (Index k = 0; k < q_; ++k)
            if (r_[k] > min && std::max(0.0, u_[k]) / r_[k] < first.step) first = {k, std::max(0.0, u_[k]) / r_[k]};
        return first;
    }

    /// Rotates columns k and k + 1 of J so that of (a, b), the rows k and k + 1 of a column of J' N, b becomes 0.
    std::pair<double, double> rotate(Index k, double& a, double& b) {
        const double length = std::hypot(a, b);
        if (b == 0) return {1, 0};
        const double c = a / length, s = b / length;
        a = length;
        b = 0;
        for (Index i = 0; i < n_; ++i) {
            const double left = J_(i, k), right = J_(i, k + 1);
            J_(i, k) = c * left + s * right;
            J_(i, k + 1) = c * right - s * left;
        }
        return {c, s};
    }

    void join(Index i) {
        for (Index k = n_ - 2; k >= q_; --k) rotate(k, d_[k], d_[k + 1]);
        R_.col(q_).head(q_ + 1) = d_.head(q_ + 1);
        active_[q_++] = int(i);
    }

    void leave(Index at) {
        --q_;
        for (Index k = at; k < q_; ++k) {
            active_[k] = active_[k + 1];
            u_[k] = u_[k + 1];
            R_.col(k).head(k + 2) = R_.col(k + 1).head(k + 2);
        }
        for (Index k = at; k < q_; ++k) {
            const auto [c, s] = rotate(k, R_(k, k), R_(k + 1, k));
            for (Index l = k + 1; l < q_; ++l) {
                const double upper = R_(k, l), lower = R_(k + 1, l);
                R_(k, l) = c * upper + s * lower;
                R_(k + 1, l) = c * lower - s * upper;
            }
        }
    }

    /// Solves with the active constraints as equations: x = J y, where R' y1 = -b of the active ones and y2 = -J2' g.
    void move_to_minimum() {
        const auto R = R_.topLeftCorner(q_, q_).template triangularView<Eigen::Upper>();
        d_.noalias() = J_.transpose() * program_.g;
        y_ = -d_;
        for (Index k = 0; k < q_; ++k) y_[k] = -program_.b[active_[k]];
        R.transpose().solveInPlace(y_.head(q_));
        u_.head(q_) = y_.head(q_) + d_.head(q_);
        R.solveInPlace(u_.head(q_));
        x_.noalias() = J_ * y_;
    }

    QuadraticMinimum<N, M> minimum() const {
        QuadraticMinimum<N, M> result{x_, Program::Bounds::Zero(program_.constraints)};
        for (Index k = 0; k < q_; ++k) result.multipliers[active_[k]] = std::max(0.0, u_[k]);
        return result;
    }

    static constexpr ActiveSetConstants k_{};
    static constexpr double kInfinity = std::numeric_limits<double>::infinity();

    const Program& program_;
    Index n_, q_ = 0;   // unknowns, active constraints
    Matrix J_, R_;      // R in its first q rows and columns
    Vector x_, y_, u_;  // x, y as above; u: the multipliers of the active constraints
    Vector d_, r_;
    Eigen::Matrix<int, Eigen::Dynamic, 1, 0, N, 1> active_;
};

}  // namespace

template <int N, int M>
std::optional<QuadraticMinimum<N, M>> solve(const QuadraticProgram<N, M>& program) {
    return DualActiveSet<N, M>(program).solve();
}

template std::optional<QuadraticMinimum<4, 14>> solve(const SmallProgram&);
template std::optional<QuadraticMinimum<Eigen::Dynamic, Eigen::Dynamic>> solve(const LargeProgram&);

}  // namespace tunewright::optimise
