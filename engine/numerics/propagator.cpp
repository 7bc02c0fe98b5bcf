#include "engine/numerics/propagator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/numerics/matrix/eigenvalues.h"
#include "engine/numerics/matrix/linear_algebra.h"

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr double kTaylorNorm = 0.5;  // norm of F h in the states' own units: up to it the series loses no digits
constexpr int kMaxTerms = 40;        // of the series: 0.5^40/40! is far below rounding; also ends the series for
                                     // numbers out of range

constexpr Index kInputs = 5;  // of a step in addition to its states: the cubic's coefficients and the constant

/// The exponential series of F h on the columns of [I G b], term by term; the moments' series have the same terms with
/// other weights.
class Series {
public:
    /// `F`: in columns of ExactStep's length.
    Series(const std::vector<double>& F, const std::vector<double>& G, const std::vector<double>& b, double h)
        : F_(F), n_(G.size()), length_(column_length(n_)), h_(h), term_(length_ * (n_ + 2), 0.0) {
        for (Index i = 0; i < n_; ++i) {
            term_[i * length_ + i] = 1;
            term_[n_ * length_ + i] = G[i];
            term_[(n_ + 1) * length_ + i] = b[i];
        }
        step_.h = h;
        step_.n = n_;
        step_.columns.assign(length_ * (n_ + kInputs), 0.0);
    }

    ExactStep sum() {
        for (int m = 0; m < kMaxTerms; ++m) {
            if (!add(m) && m > 0) break;
            multiply_columns({.columns = F_.data(),
                              .length = length_,
                              .n = n_,
                              .weights = term_.data(),
                              .weights_apart = length_,
                              .count = n_ + 2,
                              .factor = h_ / (m + 1),
                              .to = term_.data(),
                              .to_apart = length_});
        }
        return std::move(step_);
    }

private:
    /// Term m of the exponential is F^m h^m/m! x; of the moment of s^j/j! it is F^m h^(m + k)/(m + k)! x with k = j +
    /// 1. False: the terms are negligible, checked for each component separately, because their units may differ
    /// widely.
    bool add(int m) {
        double* to = step_.columns.data();
        const double* from = term_.data();
        const Index of_G = n_ * length_, of_b = of_G + length_;
        bool counting = add_columns(to, from, of_G, 1);
        double weight = 1;
        for (Index k = 0; k < 4; ++k) {
            weight *= h_ / (m + int(k) + 1);
            counting |= add_columns(to + of_G + k * length_, from + of_G, length_, weight);
        }
        counting |= add_columns(to + of_G + 4 * length_, from + of_b, length_, h_ / (m + 1));
        return counting;
    }

    const std::vector<double>& F_;
    Index n_, length_;
    double h_;
    std::vector<double> term_;
    ExactStep step_;
};

/// Converts rows to columns of ExactStep's length.
std::vector<double> in_columns(const std::vector<double>& F, Index n) {
    const Index length = column_length(n);
    std::vector<double> columns(n * length, 0.0);
    for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j) columns[j * length + i] = F[i * n + j];
    return columns;
}

}  // namespace

Propagator::Propagator(int n, const std::vector<double>& F, std::vector<double> G, std::vector<double> b, double h0)
    : n_(n), F_(in_columns(F, Index(n))), G_(std::move(G)), b_(std::move(b)), h0_(h0), norm_(balanced_norm(F, n)) {}

bool Propagator::is_of(const std::vector<double>& F, const std::vector<double>& G, const std::vector<double>& b,
                       double h0) const {
    return h0 == h0_ && G == G_ && b == b_ && in_columns(F, Index(n_)) == F_;
}

ExactStep Propagator::step(double h) const {
    // Taylor series on a step short enough for it (norm <= 1/2 in the states' own units), then doubling up to h.
    const int halvings = std::max(
        0,
        static_cast<int>(std::ceil(std::log2(std::max(norm_ * h, std::numeric_limits<double>::min()) / kTaylorNorm))));
    ExactStep step = Series(F_, G_, b_, std::ldexp(h, -halvings)).sum();
    for (int i = 0; i < halvings; ++i) step = compose(step, step);
    return step;
}

const ExactStep& Propagator::level(int level) {
    if (levels_.empty()) levels_.push_back(step(h0_));
    while (static_cast<int>(levels_.size()) <= level) levels_.push_back(compose(levels_.back(), levels_.back()));
    return levels_[Index(level)];
}

ColumnProduct carried_over(const ExactStep& second, const ExactStep& first, double* to) {
    return {.columns = second.columns.data(),
            .length = second.length(),
            .n = second.n,
            .weights = first.columns.data(),
            .weights_apart = first.length(),
            .count = first.n + kInputs,
            .to = to,
            .to_apart = first.length()};
}

ExactStep Propagator::compose(const ExactStep& first, const ExactStep& second) const {
    const Index n = Index(n_), length = first.length();
    ExactStep whole{.h = first.h + second.h, .n = n, .columns = std::vector<double>(first.columns.size())};
    multiply_columns(carried_over(second, first, whole.columns.data()));
    // v(a + s) has Taylor coefficients sum_{j >= i} v_j a^(j-i)/(j-i)! in s.
    const double a = first.h, a2 = a * a / 2, a3 = a2 * a / 3;
    const double* from = second.columns.data() + n * length;
    double* to = whole.columns.data() + n * length;
    for (Index i = 0; i < length; ++i) {
        const double g0 = from[i], g1 = from[length + i], g2 = from[2 * length + i], g3 = from[3 * length + i];
        to[i] += g0;
        to[length + i] += g1 + a * g0;
        to[2 * length + i] += g2 + a * g1 + a2 * g0;
        to[3 * length + i] += g3 + a * g2 + a2 * g1 + a3 * g0;
        to[4 * length + i] += from[4 * length + i];
    }
    return whole;
}

std::vector<double> carried_over(const ExactStep& step, std::span<const double> row) {
    std::vector<double> carried(step.n);
    for (Index k = 0; k < step.n; ++k) carried[k] = dot(row, step.column(k));
    return carried;
}

}  // namespace tunewright
