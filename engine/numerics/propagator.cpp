#include "engine/numerics/propagator.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

#include "engine/numerics/matrix/eigenvalues.h"
#include "engine/numerics/matrix/linear_algebra.h"
#include "engine/numerics/pair.h"

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr double kTaylorNorm = 0.5;    // of F h in the states' own units: up to it the series loses no digits
constexpr int kMaxTerms = 40;          // of the series: 0.5^40/40! is far below rounding; stops numbers out of range
constexpr double kNegligible = 1e-18;  // of a component's sum: well below rounding

constexpr Index kInputs = 5;  // of a step beside its states: the cubic's coefficients and the constant

Index pairs_of(Index n) { return (n + 1) / 2; }

/// Calls `act` with the number of pairs as a constant of the program; false: there are too many.
template <class Act>
bool with_pairs(Index pairs, const Act& act) {
    switch (pairs) {
        case 1: act(std::integral_constant<Index, 1>()); return true;
        case 2: act(std::integral_constant<Index, 2>()); return true;
        case 3: act(std::integral_constant<Index, 3>()); return true;
        case 4: act(std::integral_constant<Index, 4>()); return true;
        case 5: act(std::integral_constant<Index, 5>()); return true;
        case 6: act(std::integral_constant<Index, 6>()); return true;
        default: return false;
    }
}

/// out += the columns' combination with these weights, for columns of kPairs pairs: so many sums stay in registers.
template <Index kPairs>
void combine(const double* columns, const double* weights, Index count, std::array<Pair, kPairs>& out) {
    for (Index k = 0; k < count; ++k)
        for (Index i = 0; i < kPairs; ++i) out[i] += load(columns + 2 * (k * kPairs + i)) * weights[k];
}

/// For any number of pairs; what is not weighted costs nothing: a chain of lags has more of that than of anything else.
void combine(const double* columns, Index pairs, const double* weights, Index count, double* out) {
    for (Index k = 0; k < count; ++k) {
        if (weights[k] == 0) continue;
        for (Index i = 0; i < pairs; ++i)
            store(out + 2 * i, load(out + 2 * i) + load(columns + 2 * (k * pairs + i)) * weights[k]);
    }
}

/// to_k := factor times the columns' combination with weights_k, for every k: a product of matrices whose columns have
/// the same length. `to` may be `weights`.
void multiply_columns(const double* columns, const double* weights, Index n, Index count, double factor, double* to) {
    const Index pairs = pairs_of(n);
    const auto in_registers = [&]<Index kPairs>(std::integral_constant<Index, kPairs>) {
        for (Index k = 0; k < count; ++k) {
            std::array<Pair, kPairs> sum{};
            combine<kPairs>(columns, weights + 2 * kPairs * k, n, sum);
            for (Index i = 0; i < kPairs; ++i) store(to + 2 * (k * kPairs + i), factor * sum[i]);
        }
    };
    if (with_pairs(pairs, in_registers)) return;
    std::vector<double> sum(2 * pairs);
    for (Index k = 0; k < count; ++k) {
        std::fill(sum.begin(), sum.end(), 0.0);
        combine(columns, pairs, weights + 2 * pairs * k, n, sum.data());
        for (Index i = 0; i < sum.size(); ++i) to[2 * pairs * k + i] = factor * sum[i];
    }
}

/// The exponential series of F h on the columns of [I G b], term by term; the moments' series have the same terms with
/// other weights.
class Series {
public:
    /// `F`: in columns of ExactStep's length.
    Series(const std::vector<double>& F, const std::vector<double>& G, const std::vector<double>& b, double h)
        : F_(F), n_(G.size()), length_(2 * pairs_of(n_)), h_(h), term_(length_ * (n_ + 2), 0.0) {
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
            multiply_columns(F_.data(), term_.data(), n_, n_ + 2, h_ / (m + 1), term_.data());
        }
        return std::move(step_);
    }

private:
    /// Term m of the exponential is F^m h^m/m! x; of the moment of s^j/j! it is F^m h^(m + k)/(m + k)! x with k = j
    /// + 1. False: the terms count no more; each component by itself, as they may be in units far apart.
    bool add(int m) {
        double* to = step_.columns.data();
        const double* from = term_.data();
        const Index of_G = n_ * length_, of_b = of_G + length_;
        PairMask counting{};
        const auto add_to = [&](Index i, Pair term) {
            const Pair sum = load(to + i) + term;
            store(to + i, sum);
            counting |= size(term) > kNegligible * size(sum);
        };
        for (Index i = 0; i < of_G; i += 2) add_to(i, load(from + i));
        double weight = 1;
        for (Index k = 0; k < 4; ++k) {
            weight *= h_ / (m + int(k) + 1);
            for (Index i = 0; i < length_; i += 2) add_to(of_G + k * length_ + i, load(from + of_G + i) * weight);
        }
        for (Index i = 0; i < length_; i += 2) add_to(of_G + 4 * length_ + i, load(from + of_b + i) * (h_ / (m + 1)));
        return any(counting);
    }

    const std::vector<double>& F_;
    Index n_, length_;
    double h_;
    std::vector<double> term_;
    ExactStep step_;
};

/// Row by row to columns of ExactStep's length.
std::vector<double> in_columns(const std::vector<double>& F, Index n) {
    const Index length = 2 * pairs_of(n);
    std::vector<double> columns(n * length, 0.0);
    for (Index i = 0; i < n; ++i)
        for (Index j = 0; j < n; ++j) columns[j * length + i] = F[i * n + j];
    return columns;
}

}  // namespace

Propagator::Propagator(int n, const std::vector<double>& F, std::vector<double> G, std::vector<double> b, double h0)
    : n_(n), F_(in_columns(F, Index(n))), G_(std::move(G)), b_(std::move(b)), h0_(h0), norm_(balanced_norm(F, n)) {}

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

ExactStep Propagator::compose(const ExactStep& first, const ExactStep& second) const {
    const Index n = Index(n_), length = first.length();
    ExactStep whole{.h = first.h + second.h, .n = n, .columns = std::vector<double>(first.columns.size())};
    multiply_columns(second.columns.data(), first.columns.data(), n, n + kInputs, 1, whole.columns.data());
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

void advance(const ExactStep& step, const Cubic& v, std::vector<double>& x, std::vector<double>& scratch) {
    const Index n = step.n, length = step.length();
    const double *inputs = step.columns.data() + n * length, *constant = inputs + v.size() * length;
    const auto in_registers = [&]<Index kPairs>(std::integral_constant<Index, kPairs>) {
        std::array<Pair, kPairs> sum{}, forced;
        for (Index i = 0; i < kPairs; ++i) forced[i] = load(constant + 2 * i);
        combine<kPairs>(inputs, v.data(), v.size(), forced);
        combine<kPairs>(step.columns.data(), x.data(), n, sum);
        for (Index i = 0; i < n / 2; ++i) store(x.data() + 2 * i, sum[i] + forced[i]);
        if (n % 2 == 1) x[n - 1] = (sum[n / 2] + forced[n / 2])[0];
    };
    if (with_pairs(pairs_of(n), in_registers)) return;
    scratch.assign(constant, constant + length);
    combine(inputs, pairs_of(n), v.data(), v.size(), scratch.data());
    combine(step.columns.data(), pairs_of(n), x.data(), n, scratch.data());
    std::copy_n(scratch.begin(), n, x.begin());
}

std::vector<double> carried_over(const ExactStep& step, std::span<const double> row) {
    std::vector<double> carried(step.n);
    for (Index k = 0; k < step.n; ++k) carried[k] = dot(row, step.column(k));
    return carried;
}

}  // namespace tunewright
