#include "engine/numerics/propagator.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/numerics/eigenvalues.h"
#include "engine/numerics/linear_algebra.h"

namespace tunewright {
namespace {

using Index = std::size_t;

constexpr double kTaylorNorm = 0.5;    // of F h in the states' own units: up to it the series loses no digits
constexpr int kMaxTerms = 40;          // of the series: 0.5^40/40! is far below rounding; stops numbers out of range
constexpr double kNegligible = 1e-18;  // of a component's largest term: well below rounding

/// out = A B for A of n x n and B of n rows, both row by row. A's zeros are skipped: a chain of lags has more of them
/// than of anything else.
void product(const double* A, const std::vector<double>& B, int n, std::vector<double>& out) {
    const Index rows = Index(n), columns = B.size() / rows;
    std::fill(out.begin(), out.end(), 0.0);
    for (Index i = 0; i < rows; ++i)
        for (Index k = 0; k < rows; ++k) {
            const double a = A[i * rows + k];
            if (a == 0) continue;
            const double* from = B.data() + k * columns;
            double* to = out.data() + i * columns;
            for (Index j = 0; j < columns; ++j) to[j] += a * from[j];
        }
}

/// The exponential series of F h on the columns of [I G b], term by term; the moments' series have the same terms with
/// other weights.
class Series {
public:
    Series(const std::vector<double>& F, const std::vector<double>& G, const std::vector<double>& b, int n, double h)
        : F_(F), n_(Index(n)), columns_(n_ + 2), h_(h), term_(n_ * columns_, 0.0), next_(term_), largest_(term_) {
        for (Index i = 0; i < n_; ++i) {
            term_[i * columns_ + i] = 1;
            term_[i * columns_ + n_] = G[i];
            term_[i * columns_ + n_ + 1] = b[i];
        }
        step_.h = h;
        step_.Phi.assign(n_ * n_, 0.0);
        for (auto* sums : {&step_.Gamma[0], &step_.Gamma[1], &step_.Gamma[2], &step_.Gamma[3], &step_.constant})
            sums->assign(n_, 0.0);
    }

    ExactStep sum() {
        for (int m = 0; m < kMaxTerms; ++m) {
            add(m);
            if (negligible() && m > 0) break;
            product(F_.data(), term_, int(n_), next_);
            const double factor = h_ / (m + 1);
            for (Index i = 0; i < next_.size(); ++i) term_[i] = next_[i] * factor;
        }
        return std::move(step_);
    }

private:
    /// Term m of the exponential is F^m h^m/m! x; of the moment of s^j/j! it is F^m h^(m + k)/(m + k)! x with k = j
    /// + 1.
    void add(int m) {
        std::array<double, 4> weight{};
        double w = 1;
        for (int k = 1; k <= 4; ++k) weight[Index(k - 1)] = w *= h_ / (m + k);
        for (Index i = 0; i < n_; ++i) {
            const double* row = term_.data() + i * columns_;
            for (Index j = 0; j < n_; ++j) step_.Phi[i * n_ + j] += row[j];
            for (Index k = 0; k < 4; ++k) step_.Gamma[k][i] += row[n_] * weight[k];
            step_.constant[i] += row[n_ + 1] * weight[0];
        }
    }

    /// Each component by itself: they may be in units far apart.
    bool negligible() {
        bool all = true;
        for (Index i = 0; i < term_.size(); ++i) {
            const double size = std::abs(term_[i]);
            largest_[i] = std::max(largest_[i], size);
            all = all && size <= kNegligible * largest_[i];
        }
        return all;
    }

    const std::vector<double>& F_;
    Index n_, columns_;
    double h_;
    std::vector<double> term_, next_, largest_;
    ExactStep step_;
};

}  // namespace

Propagator::Propagator(int n, std::vector<double> F, std::vector<double> G, std::vector<double> b, double h0)
    : n_(n), F_(std::move(F)), G_(std::move(G)), b_(std::move(b)), h0_(h0), norm_(balanced_norm(F_, n)) {}

ExactStep Propagator::step(double h) const {
    // Taylor series on a step short enough for it (norm <= 1/2 in the states' own units), then doubling up to h.
    const int halvings = std::max(
        0,
        static_cast<int>(std::ceil(std::log2(std::max(norm_ * h, std::numeric_limits<double>::min()) / kTaylorNorm))));
    ExactStep step = Series(F_, G_, b_, n_, std::ldexp(h, -halvings)).sum();
    for (int i = 0; i < halvings; ++i) step = compose(step, step);
    return step;
}

const ExactStep& Propagator::level(int level) {
    if (levels_.empty()) levels_.push_back(step(h0_));
    while (static_cast<int>(levels_.size()) <= level) levels_.push_back(compose(levels_.back(), levels_.back()));
    return levels_[Index(level)];
}

ExactStep Propagator::compose(const ExactStep& first, const ExactStep& second) const {
    ExactStep whole;
    whole.h = first.h + second.h;
    whole.Phi.resize(first.Phi.size());
    product(second.Phi.data(), first.Phi, n_, whole.Phi);
    // v(a + s) has Taylor coefficients sum_{j >= i} v_j a^(j-i)/(j-i)! in s.
    const double a = first.h, a2 = a * a / 2, a3 = a2 * a / 3;
    for (auto& moments : whole.Gamma) moments.resize(Index(n_));
    whole.constant.resize(Index(n_));
    for (Index i = 0; i < Index(n_); ++i) {
        const double* row = second.Phi.data() + i * Index(n_);
        std::array<double, 5> carried{};
        for (Index k = 0; k < Index(n_); ++k) {
            for (Index j = 0; j < 4; ++j) carried[j] += row[k] * first.Gamma[j][k];
            carried[4] += row[k] * first.constant[k];
        }
        const auto& g = second.Gamma;
        whole.Gamma[0][i] = carried[0] + g[0][i];
        whole.Gamma[1][i] = carried[1] + g[1][i] + a * g[0][i];
        whole.Gamma[2][i] = carried[2] + g[2][i] + a * g[1][i] + a2 * g[0][i];
        whole.Gamma[3][i] = carried[3] + g[3][i] + a * g[2][i] + a2 * g[1][i] + a3 * g[0][i];
        whole.constant[i] = carried[4] + second.constant[i];
    }
    return whole;
}

void advance(const ExactStep& step, const std::array<double, 4>& v, std::vector<double>& x,
             std::vector<double>& scratch) {
    const Index n = x.size();
    const double *row = step.Phi.data(), *in = x.data();
    const double *g0 = step.Gamma[0].data(), *g1 = step.Gamma[1].data(), *g2 = step.Gamma[2].data(),
                 *g3 = step.Gamma[3].data();
    for (Index i = 0; i < n; ++i, row += n) {
        double sum = step.constant[i] + g0[i] * v[0] + g1[i] * v[1] + g2[i] * v[2] + g3[i] * v[3];
        for (Index j = 0; j < n; ++j) sum += row[j] * in[j];
        scratch[i] = sum;
    }
    x.swap(scratch);
}

}  // namespace tunewright
