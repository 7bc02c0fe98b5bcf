#include "engine/numerics/polynomial_roots.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "engine/numerics/matrix/eigenvalues.h"
#include "engine/numerics/matrix/linear_algebra.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;
using Index = std::size_t;

constexpr double kRelativeRootTolerance =
    4096 * std::numeric_limits<double>::epsilon();  // relative to coefficients and to neighbouring roots
constexpr double kRootSpreadFactor = 4;             // distance of a split multiple root from its centre, in eps^(1/m)
constexpr int kNewtonSteps = 3;  // a simple root has half its digits at first; each step doubles them

Complex horner(std::span<const double> coefficients, Complex x) {
    Complex value = 0;
    for (const double c : coefficients) value = value * x + c;
    return value;
}

Complex horner_derivative(std::span<const double> coefficients, Complex x) {
    Complex value = 0;
    const auto degree = coefficients.size() - 1;
    for (std::size_t i = 0; i < degree; ++i) value = value * x + coefficients[i] * static_cast<double>(degree - i);
    return value;
}

/// The monic polynomial with these roots, scaled so that the roots have size one, with the sums of absolute terms.
struct Product {
    std::vector<Complex> coefficients{1.0};
    std::vector<double> sizes{1.0};

    explicit Product(const std::vector<Complex>& roots, double scale) {
        for (const Complex root : roots) {
            coefficients.emplace_back(0);
            sizes.push_back(0);
            for (Index i = coefficients.size() - 1; i > 0; --i) {
                coefficients[i] -= root / scale * coefficients[i - 1];
                sizes[i] += std::abs(root / scale) * sizes[i - 1];
            }
        }
    }
};

/// The given polynomial, monic and scaled by the roots' geometric mean, so that powers of it neither overflow nor
/// underflow.
class Given {
public:
    explicit Given(std::span<const double> coefficients) : degree_(coefficients.size() - 1) {
        const double last = std::abs(coefficients[degree_] / coefficients[0]);
        scale_ = last > 0 ? std::pow(last, 1.0 / static_cast<double>(degree_)) : 1;
        for (Index i = 0; i <= degree_; ++i)
            monic_.push_back(coefficients[i] / coefficients[0] / std::pow(scale_, static_cast<double>(i)));
    }

    /// Error of the coefficients of these roots' polynomial, relative to the terms that they are sums of.
    double error_of(const std::vector<Complex>& roots) const {
        const Product product(roots, scale_);
        double worst = 0;
        for (Index i = 0; i <= degree_; ++i)
            if (const double off = std::abs(product.coefficients[i] - monic_[i]); !(off <= worst * product.sizes[i]))
                worst = product.sizes[i] > 0 ? off / product.sizes[i] : off;
        return worst;
    }

    double scale() const { return scale_; }
    const std::vector<double>& monic() const { return monic_; }

private:
    Index degree_;
    double scale_ = 1;
    std::vector<double> monic_;
};

Complex newton(std::span<const double> coefficients, Complex root) {
    for (int iteration = 0; iteration < kNewtonSteps; ++iteration) {
        const Complex value = horner(coefficients, root);
        const Complex slope = horner_derivative(coefficients, root);
        if (std::abs(slope) == 0) break;
        Complex better = root - value / slope;
        if (root.imag() == 0) better = better.real();
        if (!(std::abs(horner(coefficients, better)) < std::abs(value))) break;
        root = better;
    }
    return root;
}

/// Improves each root separately, pairs together, if that brings the polynomial nearer: Newton's method on one root of
/// a cluster could make the product worse, and could exchange the two roots of a narrow pair.
void polish(std::span<const double> coefficients, const Given& given, std::vector<Complex>& roots) {
    double error = given.error_of(roots);
    for (Index i = 0; i < roots.size(); ++i) {
        const bool pair = roots[i].imag() > 0 && i + 1 < roots.size();
        const Complex better = newton(coefficients, roots[i]);
        std::vector<Complex> moved = roots;
        moved[i] = better;
        if (pair) moved[i + 1] = std::conj(better);
        if (!pair || better.imag() > 0)
            if (const double now = given.error_of(moved); now < error) {
                roots = std::move(moved);
                error = now;
            }
        if (pair) ++i;
    }
}

class Merger {
public:
    Merger(const Given& given, std::vector<Complex>& roots) : given_(given), roots_(roots), degree_(roots.size()) {}

    void run() {
        // All groups at once, because a split root nearby makes the test of a single group fail; otherwise the isolated
        // groups.
        const std::vector<Group> groups = find_groups();
        std::vector<Complex> all = roots_;
        for (const Group& group : groups) put(group, all);
        if (is_given(all)) {
            roots_ = std::move(all);
            return;
        }
        for (const Group& group : groups) {
            std::vector<Complex> one = roots_;
            put(group, one);
            if (is_given(one)) roots_ = std::move(one);
        }
    }

private:
    using Group = std::vector<Index>;

    /// Largest first: m roots, with no other root within the distance to which an m-fold root splits.
    std::vector<Group> find_groups() const {
        std::vector<Group> groups;
        std::vector<bool> taken(degree_, false);
        for (Index m = degree_; m >= 2; --m)
            for (Index i = 0; i < degree_; ++i) {
                if (taken[i]) continue;
                Group near;
                for (Index k = 0; k < degree_; ++k)
                    if (!taken[k] && std::abs(roots_[k] - roots_[i]) <= 2 * reach(m) * std::abs(roots_[i]))
                        near.push_back(k);
                if (near.size() != m) continue;
                for (const Index k : near) taken[k] = true;
                groups.push_back(std::move(near));
            }
        return groups;
    }

    static double reach(Index m) {
        return kRootSpreadFactor * std::pow(std::numeric_limits<double>::epsilon(), 1.0 / static_cast<double>(m));
    }

    /// Replaces the group by one point, which is real unless the group lies on one side of the axis.
    void put(const Group& group, std::vector<Complex>& roots) const {
        Complex centre = 0;
        for (const Index k : group) centre += roots_[k] / static_cast<double>(group.size());
        const bool above = std::ranges::all_of(group, [&](Index k) { return roots_[k].imag() > 0; }),
                   below = std::ranges::all_of(group, [&](Index k) { return roots_[k].imag() < 0; });
        const bool real = !above && !below;
        centre = refined(real ? centre.real() : centre, group.size());
        for (const Index k : group) roots[k] = centre;
        if (real) return;
        for (const Index k : group) roots[partner(k)] = std::conj(centre);
    }

    Index partner(Index k) const { return roots_[k].imag() > 0 ? k + 1 : k - 1; }

    /// Newton's method on the (m - 1)th derivative, whose root at the centre is simple.
    Complex refined(Complex centre, Index m) const {
        std::vector<double> p = given_.monic();
        for (Index k = 1; k < m; ++k) {
            p.pop_back();
            for (Index i = 0; i < p.size(); ++i) p[i] *= static_cast<double>(p.size() - i);
        }
        Complex s = centre / given_.scale();
        for (int step = 0; step < kNewtonSteps; ++step) {
            Complex value = 0, slope = 0;
            for (const double c : p) {
                slope = slope * s + value;
                value = value * s + c;
            }
            if (slope == 0.0) break;
            s -= value / slope;
        }
        return s * given_.scale();
    }

    bool is_given(const std::vector<Complex>& roots) const { return given_.error_of(roots) <= kRelativeRootTolerance; }

    const Given& given_;
    std::vector<Complex>& roots_;
    Index degree_;
};

/// Rounding of the coefficients splits an m-fold root over about eps^(1/m) of itself, differently for every scale of s.
/// A group of roots that close is replaced by one point, its centre as a root of the (m - 1)th derivative, if the
/// resulting polynomial equals the given one to the rounding of its coefficients. Other groups stay as they are.
/// `roots`: conjugate pairs as neighbours.
void merge_multiple_roots(const Given& given, std::vector<Complex>& roots) {
    if (roots.size() >= 2) Merger(given, roots).run();
}

}  // namespace

std::vector<Complex> polynomial_roots(std::span<const double> coefficients) {
    const int n = static_cast<int>(coefficients.size()) - 1;
    if (n <= 0) return {};
    if (n == 1) return {Complex(-coefficients[1] / coefficients[0])};
    // s = scale x makes the first and the last coefficient equal.
    const double last = coefficients[static_cast<Index>(n)];
    const double scale = last == 0 ? 1 : std::pow(std::abs(last / coefficients[0]), 1.0 / n);
    const auto size = static_cast<Index>(n);
    std::vector<double> companion(size * size, 0.0);
    for (int i = 0; i < n; ++i)
        companion[static_cast<Index>(i)] =
            -coefficients[static_cast<Index>(i) + 1] / coefficients[0] / std::pow(scale, i + 1);
    for (Index i = 1; i < size; ++i) companion[i * size + i - 1] = 1;
    std::vector<Complex> roots = eigenvalues(companion, n);
    for (auto& root : roots) root *= scale;
    if (roots.size() != size) return roots;
    const Given given(coefficients);
    polish(coefficients, given, roots);
    merge_multiple_roots(given, roots);
    return roots;
}

}  // namespace tunewright
