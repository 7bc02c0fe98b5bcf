#include "engine/plant/multiple_roots.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace tunewright {
namespace {

using Complex = std::complex<double>;
using Index = std::size_t;

constexpr double kRounding = 32 * std::numeric_limits<double>::epsilon();
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
        for (Index m = degree_; m >= 2; --m)
            for (Index i = 0; i < degree_; ++i) try_group(i, m);
    }

private:
    /// The m roots nearest to root i, as one.
    void try_group(Index i, Index m) {
        const double reach = kSpread * std::pow(std::numeric_limits<double>::epsilon(), 1.0 / static_cast<double>(m));
        std::vector<Index> near;
        for (Index k = 0; k < degree_; ++k)
            if (std::abs(roots_[k] - roots_[i]) <= 2 * reach * std::abs(roots_[i])) near.push_back(k);
        if (near.size() != m) return;
        Complex centre = 0;
        for (const Index k : near) centre += roots_[k] / static_cast<double>(m);
        double off_axis = 0;
        for (const Index k : near) off_axis += roots_[k].imag();
        const bool real = std::abs(off_axis) <= reach * std::abs(centre);
        if (real) centre = centre.real();
        centre = refined(centre, m);
        std::vector<Complex> merged = roots_;
        for (const Index k : near) {
            merged[k] = centre;
            if (!real) merged[partner(k)] = std::conj(centre);
        }
        if (is_given(merged)) roots_ = std::move(merged);
    }

    Index partner(Index k) const { return roots_[k].imag() > 0 ? k + 1 : k - 1; }

    /// Newton's method on the derivative of which the centre is a simple root.
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
