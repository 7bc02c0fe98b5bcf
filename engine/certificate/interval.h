// Intervals that enclose real numbers: each operation rounds outwards.
//
// IEEE 754 rounds sums, products, quotients and square roots to the nearest double, an error of at most 2^-53 of the
// result (1.11e-16) unless it underflows. kUnit of the result, taken off below and added above, is at least twice that,
// so that the rounding of this step itself is covered too; kTiny covers underflow. The C library states that its exp,
// sin and cos err by at most one unit in the last place; kFunctionUnit allows for four.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tunewright::certificate {

class Interval {
public:
    Interval() = default;
    Interval(double x) : low_(x), high_(x) {}  // NOLINT(google-explicit-constructor)

    /// The interval around two computed ends, each with a rounding error.
    static Interval around(double low, double high, double unit = kUnit) {
        if (!(low <= high)) return everything();
        return {low - (std::abs(low) * unit + kTiny), high + (std::abs(high) * unit + kTiny), Exact()};
    }
    /// The interval with exactly these ends.
    static Interval between(double low, double high) {
        return low <= high ? Interval(low, high, Exact()) : everything();
    }
    static Interval everything() {
        return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity(), Exact()};
    }
    static Interval pi() { return around(std::numbers::pi, std::numbers::pi); }

    double low() const { return low_; }
    double high() const { return high_; }

    friend Interval operator+(Interval a, Interval b) { return around(a.low_ + b.low_, a.high_ + b.high_); }
    friend Interval operator-(Interval a, Interval b) { return around(a.low_ - b.high_, a.high_ - b.low_); }
    friend Interval operator-(Interval a) { return {-a.high_, -a.low_, Exact()}; }
    friend Interval operator*(Interval a, Interval b) {
        const double p = a.low_ * b.low_, q = a.low_ * b.high_, r = a.high_ * b.low_, s = a.high_ * b.high_;
        if (!std::isfinite(p + q + r + s)) return everything();
        return around(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
    }
    friend Interval operator/(Interval a, Interval b) {
        if (!(b.low_ > 0) && !(b.high_ < 0)) return everything();
        return a * around(1 / b.high_, 1 / b.low_);
    }

private:
    struct Exact {};
    Interval(double low, double high, Exact) : low_(low), high_(high) {}

    static constexpr double kUnit = 4e-16, kTiny = 1e-300;

    double low_ = 0, high_ = 0;
};

inline double low(double x) { return x; }
inline double high(double x) { return x; }
inline double low(Interval x) { return x.low(); }
inline double high(Interval x) { return x.high(); }

inline double square(double x) { return x * x; }
inline Interval square(Interval x) {
    if (x.low() >= 0) return Interval::around(x.low() * x.low(), x.high() * x.high());
    if (x.high() <= 0) return Interval::around(x.high() * x.high(), x.low() * x.low());
    const double most = std::max(-x.low(), x.high()), squared = most * most;
    return Interval::between(0, Interval::around(squared, squared).high());
}

inline double root(double x) { return std::sqrt(x); }
/// The square root of the part >= 0.
inline Interval root(Interval x) {
    if (!(x.high() >= 0)) return Interval::everything();
    const double least = std::sqrt(std::max(x.low(), 0.0)), most = std::sqrt(x.high());
    return Interval::between(std::max(0.0, Interval::around(least, least).low()), Interval::around(most, most).high());
}

inline double size(double x) { return std::abs(x); }
inline Interval size(Interval x) {
    if (x.low() >= 0) return x;
    if (x.high() <= 0) return -x;
    return Interval::between(0, std::max(-x.low(), x.high()));
}

inline double smaller(double a, double b) { return std::min(a, b); }
inline Interval smaller(Interval a, Interval b) {
    return Interval::between(std::min(a.low(), b.low()), std::min(a.high(), b.high()));
}
inline double larger(double a, double b) { return std::max(a, b); }
inline Interval larger(Interval a, Interval b) {
    return Interval::between(std::max(a.low(), b.low()), std::max(a.high(), b.high()));
}

constexpr double kFunctionUnit = 1e-15;

inline double exponential(double x) { return std::exp(x); }
inline Interval exponential(Interval x) {
    return Interval::around(std::exp(x.low()), std::exp(x.high()), kFunctionUnit);
}

/// sin or cos of the middle, which changes by no more than the argument.
template <double (*function)(double)>
Interval periodic(Interval x) {
    const double middle = 0.5 * (x.low() + x.high());
    const Interval radius = larger(Interval(x.high()) - Interval(middle), Interval(middle) - Interval(x.low()));
    const double value = function(middle), far = radius.high() + kFunctionUnit;
    return std::isfinite(value + far) ? Interval::around(value - far, value + far) : Interval::everything();
}
inline double cosine(double x) { return std::cos(x); }
inline double sine(double x) { return std::sin(x); }
inline Interval cosine(Interval x) { return periodic<cosine>(x); }
inline Interval sine(Interval x) { return periodic<sine>(x); }

inline void pi_of(double& x) { x = std::numbers::pi; }
inline void pi_of(Interval& x) { x = Interval::pi(); }

}  // namespace tunewright::certificate
