// Dual numbers: a value and its derivatives in N directions, carried exactly through every operation (forward automatic
// differentiation).
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>
#include <type_traits>

namespace tunewright {

template <int N>
struct Dual {
    /// A single derivative is a plain number, so that a Dual<1> is passed in registers: Taylor series then take half
    /// the time.
    using Derivatives = std::conditional_t<N == 1, double, Eigen::Array<double, N, 1>>;
    double v;
    Derivatives d;
};

template <int N>
Dual<N> constant_dual(double value) {
    if constexpr (N == 1)
        return {value, 0};
    else
        return {value, Dual<N>::Derivatives::Zero()};
}

/// A variable: its derivative in this direction (0 to N - 1) is 1.
template <int N>
Dual<N> variable_dual(double value, std::size_t direction) {
    Dual<N> result = constant_dual<N>(value);
    if constexpr (N == 1)
        result.d = 1;
    else
        result.d[static_cast<Eigen::Index>(direction)] = 1;
    return result;
}

template <int N>
double derivative(const Dual<N>& a, std::size_t direction) {
    if constexpr (N == 1)
        return a.d;
    else
        return a.d[static_cast<Eigen::Index>(direction)];
}

/// value + slope (a - a.v): any function of one variable, by its derivative. A direction on which a does not depend
/// stays 0 even if the slope is infinite.
template <int N>
Dual<N> chain(const Dual<N>& a, double value, double slope) {
    if constexpr (N == 1)
        return {value, a.d == 0 ? 0 : slope * a.d};
    else
        return {value, (a.d == 0).select(0.0, slope * a.d)};
}

template <int N>
Dual<N> operator+(const Dual<N>& a, const Dual<N>& b) {
    return {a.v + b.v, a.d + b.d};
}

template <int N>
Dual<N> operator-(const Dual<N>& a, const Dual<N>& b) {
    return {a.v - b.v, a.d - b.d};
}

template <int N>
Dual<N> operator-(const Dual<N>& a) {
    return {-a.v, -a.d};
}

template <int N>
Dual<N> operator*(const Dual<N>& a, const Dual<N>& b) {
    return {a.v * b.v, a.d * b.v + a.v * b.d};
}

template <int N>
Dual<N> operator*(const Dual<N>& a, double factor) {
    return {a.v * factor, a.d * factor};
}

template <int N>
Dual<N> operator/(const Dual<N>& a, const Dual<N>& b) {
    const double quotient = a.v / b.v;
    return {quotient, (a.d - quotient * b.d) / b.v};
}

template <int N>
Dual<N> exp(const Dual<N>& a) {
    const double value = std::exp(a.v);
    return chain(a, value, value);
}

template <int N>
Dual<N> log(const Dual<N>& a) {
    return chain(a, std::log(a.v), 1 / a.v);
}

template <int N>
Dual<N> sqrt(const Dual<N>& a) {
    const double value = std::sqrt(a.v);
    return chain(a, value, 0.5 / value);
}

template <int N>
Dual<N> sin(const Dual<N>& a) {
    return chain(a, std::sin(a.v), std::cos(a.v));
}

template <int N>
Dual<N> cos(const Dual<N>& a) {
    return chain(a, std::cos(a.v), -std::sin(a.v));
}

template <int N>
Dual<N> tan(const Dual<N>& a) {
    const double value = std::tan(a.v);
    return chain(a, value, 1 + value * value);
}

template <int N>
Dual<N> tanh(const Dual<N>& a) {
    const double value = std::tanh(a.v);
    return chain(a, value, 1 - value * value);
}

/// With a constant exponent.
template <int N>
Dual<N> pow(const Dual<N>& a, double exponent) {
    return chain(a, std::pow(a.v, exponent), exponent * std::pow(a.v, exponent - 1));
}

}  // namespace tunewright
