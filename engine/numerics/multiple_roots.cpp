#include "engine/numerics/multiple_roots.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace tunewright {
namespace {

using Complex = std::complex<double>;
using Index = std::size_t;

constexpr double kRounding = 4096 * std::numeric_limits<double>::epsilon();  // of coefficients and of roots beside
constexpr double kSpread = 4;  // a torn root's distance from its centre, in eps^(1/m)

/// Of the monic polynomial with these roots, scaled so that the roots have size one; with the sums of absolute terms.
struct Product {
    std::vector<Complex> coefficients{1.0};
    std::vector<double> sizes{1.0};

    explicit Product(const std::vector<Complex>& roots, double scale) {
        for (const Complex root : roots) {
            coefficients.push_back(0);
            sizes.push_back(0);
            for (Index i = coefficients.size() - 1; i > 0; --i) {
                coefficients[i] -= root / scale * coefficients[i - 1];
                sizes[i] += std::abs(root / scale) * sizes[i - 1];
            }
        }
    }
};

class Merger {
public:
    Merger(std::span<const double> coefficients, std::vector<Complex>& roots) : roots_(roots), degree_(roots.size()) {
        // Time in the roots' own geometric mean: powers of it neither over- nor underflow.
        const double last = std::abs(coefficients[degree_] / coefficients[0]);
        scale_ = last > 0 ? std::pow(last, 1.0 / static_cast<double>(degree_)) : 1;
        for (Index i = 0; i <= degree_; ++i)
            given_.push_back(coefficients[i] / coefficients[0] / std::pow(scale_, static_cast<double>(i)));
    }

    void run() {
        // All groups at once, since a torn one beside it spoils the test of any; else those that stand by themselves.
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

    /// Largest first: m roots that have no other within reach of an m-fold one.
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
        return kSpread * std::pow(std::numeric_limits<double>::epsilon(), 1.0 / static_cast<double>(m));
    }

    /// On one point, a real one unless the group lies on one side of the axis.
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
        std::vector<double> p = given_;
        for (Index k = 1; k < m; ++k) {
            p.pop_back();
            for (Index i = 0; i < p.size(); ++i) p[i] *= static_cast<double>(p.size() - i);
        }
        Complex s = centre / scale_;
        for (int step = 0; step < 3; ++step) {
            Complex value = 0, slope = 0;
            for (const double c : p) {
                slope = slope * s + value;
                value = value * s + c;
            }
            if (slope == 0.0) break;
            s -= value / slope;
        }
        return s * scale_;
    }

    bool is_given(const std::vector<Complex>& roots) const {
        const Product product(roots, scale_);
        for (Index i = 0; i <= degree_; ++i)
            if (!(std::abs(product.coefficients[i] - given_[i]) <= kRounding * product.sizes[i])) return false;
        return true;
    }

    std::vector<Complex>& roots_;
    Index degree_;
    double scale_ = 1;
    std::vector<double> given_;
};

}  // namespace

void merge_multiple_roots(std::span<const double> coefficients, std::vector<Complex>& roots) {
    if (roots.size() < 2 || roots.size() + 1 != coefficients.size()) return;
    Merger(coefficients, roots).run();
}

}  // namespace tunewright
