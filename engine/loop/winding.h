// The angle by which a curve turns about 0, from points along it: the sum of the argument principle, with one
// arctangent for several points instead of one for each.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>

#include "engine/numerics/fast_complex.h"

namespace tunewright {

class Winding {
public:
    using Complex = std::complex<double>;

    explicit Winding(Complex start) : anchor_(start), last_(start) {}

    /// True if the step between two points is so short that it cannot turn by more than half a radian, unless the curve
    /// makes a full turn in between.
    static bool is_short(Complex from, Complex to) {
        return magnitude(to - from) <= kLargestStep * std::min(magnitude(from), magnitude(to));
    }

    /// Continues to a point that is a short step from the last one.
    void follow(Complex to) {
        const Complex turned = quotient(to, anchor_);
        last_ = to;
        if (turned.real() > std::abs(turned.imag())) return;  // the next short step stays within half a turn
        angle_ += std::arg(turned);
        anchor_ = to;
    }

    /// Continues to any point, by a known angle.
    void turn(double angle, Complex to) {
        angle_ = this->angle() + angle;
        anchor_ = last_ = to;
    }

    double angle() const { return angle_ + std::arg(quotient(last_, anchor_)); }  ///< turned so far, rad

private:
    static constexpr double kLargestStep = 0.4;  // relative to the smaller end

    Complex anchor_, last_;  // the angle is added up as far as the anchor
    double angle_ = 0;
};

/// The change of an argument between two points whose factors `open` and `returned` change by less than half a turn
/// each; `step` is their product.
inline double turn_of(std::complex<double> step, std::complex<double> open, std::complex<double> returned) {
    return open.real() > 0 && returned.real() > 0 ? std::arg(step) : std::arg(open) + std::arg(returned);
}

}  // namespace tunewright
