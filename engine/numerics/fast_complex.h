// Product, quotient and magnitude of complex numbers where loops over frequency need millions of them: several times as
// fast as the library's, which check for special values first. The accuracy is the same. Very large and very small
// numbers are passed to the library, except that a product of infinite ones may be NaN.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>

namespace tunewright {

/// Squares of numbers within these bounds neither overflow nor underflow, and neither does a sum of two of them.
constexpr double kMinSquare = 1e-280, kMaxSquare = 1e280;
/// Reciprocals of numbers within these bounds are normal numbers.
constexpr double kMinDivisor = 1e-290, kMaxDivisor = 1e290;

/// |z| without overflow.
inline double magnitude(std::complex<double> z) {
    const double squared = std::norm(z);
    return squared > kMinSquare && squared < kMaxSquare ? std::sqrt(squared) : std::abs(z);
}

/// a b for finite numbers.
inline std::complex<double> product(std::complex<double> a, std::complex<double> b) {
    return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// n/d without overflow of intermediate results; for d = 0 the library's result.
inline std::complex<double> quotient(std::complex<double> n, std::complex<double> d) {
    const double size = std::max(std::abs(d.real()), std::abs(d.imag()));
    if (!(size > kMinDivisor && size < kMaxDivisor)) return n / d;
    const double scale = 1 / size, re = d.real() * scale, im = d.imag() * scale;
    const double inverse = scale / (re * re + im * im);
    return {(n.real() * re + n.imag() * im) * inverse, (n.imag() * re - n.real() * im) * inverse};
}

/// A divisor of several numbers.
class Divisor {
public:
    explicit Divisor(std::complex<double> d) : d_(d), inverse_(quotient(1, d)) {
        const double size = std::max(std::abs(d.real()), std::abs(d.imag()));
        ordinary_ = size > kMinDivisor && size < kMaxDivisor;
    }
    std::complex<double> under(std::complex<double> n) const {
        if (!ordinary_) return quotient(n, d_);
        return product(n, inverse_);
    }

private:
    std::complex<double> d_, inverse_;
    bool ordinary_;
};

}  // namespace tunewright
