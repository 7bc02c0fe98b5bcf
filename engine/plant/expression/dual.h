// Dual numbers: a value and its derivatives in N directions, carried exactly through every operation (forward automatic
// differentiation).
#pragma once

#include <array>
#include <cmath>

namespace tunewright {

template <int N>
struct Dual {
    double v;
    std::array<double, N> d;
};

template <int N>
Dual<N> constant_dual(double value) {
    return {value, {}};
}

/// value + slope (a - a.v): any function of one variable by its derivative.
template <int N>
Dual<N> chain(const Dual<N>& a, double value, double slope) {
    Dual<N> result;
    result.v = value;
    for (int i = 0; i < N; ++i) result.d[i] = a.d[i] == 0 ? 0 : slope * a.d[i];
    return result;
}

template <int N>
Dual<N> operator+(const Dual<N>& a, const Dual<N>& b) {
    Dual<N> result;
    result.v = a.v + b.v;
    for (int i = 0; i < N; ++i) result.d[i] = a.d[i] + b.d[i];
    return result;
}

template <int N>
Dual<N> operator-(const Dual<N>& a, const Dual<N>& b) {
    Dual<N> result;
    result.v = a.v - b.v;
    for (int i = 0; i < N; ++i) result.d[i] = a.d[i] - b.d[i];
    return result;
}

template <int N>
Dual<N> operator-(const Dual<N>& a) {
    Dual<N> result;
    result.v = -a.v;
    for (int i = 0; i < N; ++i) result.d[i] = -a.d[i];
    return result;
}

template <int N>
Dual<N> operator*(const Dual<N>& a, const Dual<N>& b) {
    Dual<N> result;
    result.v = a.v * b.v;
    for (int i = 0; i < N; ++i) result.d[i] = a.d[i] * b.v + a.v * b.d[i];
    return result;
}

template <int N>
Dual<N> operator*(const Dual<N>& a, double factor) {
    Dual<N> result;
    result.v = a.v * factor;
    for (int i = 0; i < N; ++i) result.d[i] = a.d[i] * factor;
    return result;
}

template <int N>
Dual<N> operator/(const Dual<N>& a, const Dual<N>& b) {
    Dual<N> result;
    result.v = a.v / b.v;
    for (int i = 0; i < N; ++i) result.d[i] = (a.d[i] - result.v * b.d[i]) / b.v;
    return result;
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
