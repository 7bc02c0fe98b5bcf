#include "engine/numerics/matrix_scaling.h"

#include <cmath>
#include <cstddef>
#include <limits>

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr double kNever = 1e9;  // the cost of a zero

/// Rows join one by one along the shortest alternating path. Column n stands for "none yet".
class Assignment {
public:
    Assignment(std::span<const double> matrix, Index n)
        : n_(n), rows_(n, 0.0), columns_(n + 1, 0.0), row_of_(n + 1, n) {
        for (const double entry : matrix) cost_.push_back(entry == 0 ? kNever : -std::log2(std::abs(entry)));
    }

    bool solve() {
        for (Index row = 0; row < n_; ++row)
            if (!join(row)) return false;
        return true;
    }

    MatrixScaling scaling() const {
        MatrixScaling scaling;
        for (Index i = 0; i < n_; ++i) {
            scaling.rows.push_back(std::ldexp(1.0, static_cast<int>(std::lround(rows_[i]))));
            scaling.columns.push_back(std::ldexp(1.0, static_cast<int>(std::lround(columns_[i]))));
        }
        return scaling;
    }

private:
    bool join(Index row) {
        distance_.assign(n_, std::numeric_limits<double>::infinity());
        before_.assign(n_, n_);
        used_.assign(n_ + 1, false);
        Index at = n_;
        row_of_[n_] = row;
        while (row_of_[at] < n_) {
            used_[at] = true;
            const Index next = nearest(at);
            const double step = distance_[next];
            if (step > kNever / 2) return false;
            raise(step);
            at = next;
        }
        for (; at < n_; at = before_[at]) row_of_[at] = row_of_[before_[at]];
        row_of_[n_] = n_;
        return true;
    }

    Index nearest(Index at) {
        const Index i = row_of_[at];
        Index next = n_;
        for (Index j = 0; j < n_; ++j) {
            if (used_[j]) continue;
            const double reduced = cost_[i * n_ + j] - rows_[i] - columns_[j];
            if (reduced < distance_[j]) {
                distance_[j] = reduced;
                before_[j] = at;
            }
            if (next == n_ || distance_[j] < distance_[next]) next = j;
        }
        return next;
    }

    void raise(double step) {
        for (Index j = 0; j <= n_; ++j) {
            if (used_[j]) {
                rows_[row_of_[j]] += step;
                columns_[j] -= step;
            } else if (j < n_) {
                distance_[j] -= step;
            }
        }
    }

    Index n_;
    std::vector<double> cost_, rows_, columns_;  // costs; potentials, cost - row - column >= 0
    std::vector<Index> row_of_;                  // of each column
    std::vector<double> distance_;
    std::vector<Index> before_;
    std::vector<bool> used_;
};

}  // namespace

std::optional<MatrixScaling> scaling_of(std::span<const double> matrix, int n) {
    Assignment assignment(matrix, Index(n));
    if (!assignment.solve()) return std::nullopt;
    return assignment.scaling();
}

}  // namespace tunewright
