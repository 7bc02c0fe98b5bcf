// The operations that a number type must have to run a program: its value part decides comparisons, `apply` computes
// one operation.
#pragma once

#include <cmath>
#include <complex>

#include "engine/plant/expression/dual.h"
#include "engine/plant/expression/operation.h"

namespace tunewright {

inline double value_part(double x) { return x; }
inline double value_part(const std::complex<double>& x) { return x.real(); }
template <int N>
double value_part(const Dual<N>& x) {
    return x.v;
}

inline void set_constant(double& x, double value) { x = value; }
inline void set_constant(std::complex<double>& x, double value) { x = value; }
template <int N>
void set_constant(Dual<N>& x, double value) {
    x = constant_dual<N>(value);
}

inline bool all_finite(double x) { return std::isfinite(x); }
inline bool all_finite(const std::complex<double>& x) { return std::isfinite(x.real()) && std::isfinite(x.imag()); }
template <int N>
bool all_finite(const Dual<N>& x) {
    bool finite = std::isfinite(x.v);
    for (std::size_t i = 0; i < N; ++i) finite = finite && std::isfinite(derivative(x, i));
    return finite;
}

/// 1 if it holds, 0 if not, NaN if one side is NaN.
template <class T>
T truth(bool holds, const T& a, const T& b) {
    T result;
    const double x = value_part(a), y = value_part(b);
    set_constant(result, std::isnan(x) || std::isnan(y) ? x + y : holds ? 1.0 : 0.0);
    return result;
}

/// One operation of a program; only `select` uses `c`. An undefined value is not finite. At the kink of abs, min and
/// max the derivative is that from the right, or that of the first operand.
template <class T>
T apply(Operation operation, const T& a, const T& b, const T& c) {
    using std::cos, std::exp, std::log, std::pow, std::sin, std::sqrt, std::tan, std::tanh;
    const double x = value_part(a), y = value_part(b);
    switch (operation) {
        case Operation::add: return a + b;
        case Operation::subtract: return a - b;
        case Operation::multiply: return a * b;
        case Operation::divide: return a / b;
        case Operation::negate: return -a;
        case Operation::power: return pow(a, y);
        case Operation::less: return truth(x < y, a, b);
        case Operation::less_equal: return truth(x <= y, a, b);
        case Operation::equal: return truth(x == y, a, b);
        case Operation::not_equal: return truth(x != y, a, b);
        case Operation::select: return std::isnan(x) ? a : x != 0 ? b : c;
        case Operation::exp: return exp(a);
        case Operation::log: return log(a);
        case Operation::sqrt: return sqrt(a);
        case Operation::sin: return sin(a);
        case Operation::cos: return cos(a);
        case Operation::tan: return tan(a);
        case Operation::tanh: return tanh(a);
        case Operation::abs: return x < 0 ? -a : a;
        case Operation::min: return std::isnan(x) || x <= y ? a : b;
        case Operation::max: return std::isnan(x) || x >= y ? a : b;
        default: return a;
    }
}

}  // namespace tunewright
