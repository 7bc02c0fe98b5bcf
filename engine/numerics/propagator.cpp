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

/// sum_{m>=0} F^m h^(m+k)/(m+k)! x: k = 0 the exponential's action, k = j + 1 the moment of s^j/j!.
std::vector<double> phi_action(const std::vector<double>& F, std::vector<double> x, double h, int k) {
    double factor = 1;
    for (int i = 1; i <= k; ++i) factor *= h / i;
    for (double& value : x) value *= factor;
    std::vector<double> sum = x, next(x.size()), largest(x.size());
    // Each component by itself: they may be in units far apart.
    for (Index i = 0; i < x.size(); ++i) largest[i] = std::abs(x[i]);
    bool adds = true;
    for (int m = 1; adds && m < kMaxTerms; ++m) {
        multiply(F, x, next);
        adds = false;
        for (Index i = 0; i < x.size(); ++i) {
            x[i] = next[i] * h / (m + k);
            sum[i] += x[i];
            largest[i] = std::max(largest[i], std::abs(x[i]));
            adds = adds || std::abs(x[i]) > kNegligible * largest[i];
        }
    }
    return sum;
}

}  // namespace

Propagator::Propagator(int n, std::vector<double> F, std::vector<double> G, std::vector<double> b, double h0)
    : n_(n), F_(std::move(F)), G_(std::move(G)), b_(std::move(b)), h0_(h0), norm_(balanced_norm(F_, n)) {}

ExactStep Propagator::step(double h) const {
    // Taylor series on a step short enough for it (norm <= 1/2 in the states' own units), then doubling up to h.
    const int halvings = std::max(
        0,
        static_cast<int>(std::ceil(std::log2(std::max(norm_ * h, std::numeric_limits<double>::min()) / kTaylorNorm))));
    ExactStep step;
    step.h = std::ldexp(h, -halvings);
    step.Phi.resize(Index(n_ * n_));
    std::vector<double> unit(Index(n_), 0.0);
    for (int j = 0; j < n_; ++j) {
        unit[Index(j)] = 1;
        const auto column = phi_action(F_, unit, step.h, 0);
        for (int i = 0; i < n_; ++i) step.Phi[Index(i * n_ + j)] = column[Index(i)];
        unit[Index(j)] = 0;
    }
    for (int j = 0; j < 4; ++j) step.Gamma[Index(j)] = phi_action(F_, G_, step.h, j + 1);
    step.constant = phi_action(F_, b_, step.h, 1);
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
    whole.Phi = matrix_product(second.Phi, first.Phi, n_);
    // v(a + s) has Taylor coefficients sum_{j >= i} v_j a^(j-i)/(j-i)! in s.
    for (int j = 0; j < 4; ++j) {
        std::vector<double>& carried = whole.Gamma[Index(j)];
        carried.resize(Index(n_));
        multiply(second.Phi, first.Gamma[Index(j)], carried);
        double weight = 1;
        for (int i = j; i >= 0; --i) {
            for (Index r = 0; r < Index(n_); ++r) carried[r] += second.Gamma[Index(i)][r] * weight;
            weight *= first.h / (j - i + 1);
        }
    }
    whole.constant.resize(Index(n_));
    multiply(second.Phi, first.constant, whole.constant);
    for (Index r = 0; r < Index(n_); ++r) whole.constant[r] += second.constant[r];
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
