// Extrema of a function of one unknown, and the end of the range of a property: Brent's method from a known point,
// golden sections, bisection.
#pragma once

#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

namespace tunewright {

struct Maximum {
    double x = 0;
    double value = 0;  ///< f(x)
};

/// True if a maximum with these three points (x ascending, `here` not below its neighbours) may exceed `level`: if the
/// parabola through them, with four times its height above `here`, exceeds it.
bool may_exceed(double level, const Maximum& before, const Maximum& here, const Maximum& after);

/// A maximum of f over [left, right], 0 < left < known.x < right, in ln x: Brent's method (Brent, Algorithms for
/// Minimization without Derivatives, 1973, chapter 5) from the known point, which is not below either end. The error of
/// ln x is about 1e-8, that of the value its square times f's curvature. The value is never below the known one.
Maximum log_maximum(const std::function<double(double)>& f, double left, const Maximum& known, double right);

/// The minimum point of f, unimodal on [low, high], to 0.618^sections of the interval: golden sections (Kiefer 1953,
/// Proc. Amer. Math. Soc. 4, 502-506). Needs sections + 2 values; on a plateau it returns the lower end.
template <class Function>
double golden_section(const Function& f, double low, double high, int sections) {
    constexpr double kGolden = 1 / std::numbers::phi;
    double a = high - kGolden * (high - low), b = low + kGolden * (high - low), fa = f(a), fb = f(b);
    for (int i = 0; i < sections; ++i) {
        if (fa <= fb) {
            high = std::exchange(b, a);
            fb = fa;
            fa = f(a = high - kGolden * (high - low));
        } else {
            low = std::exchange(a, b);
            fa = fb;
            fb = f(b = low + kGolden * (high - low));
        }
    }
    return 0.5 * (low + high);
}

/// Two points: the property holds at `inside` and does not hold at `outside`, which may lie on either side.
struct Bracket {
    double inside = 0, outside = 0;
};

constexpr int kMaxHalvings = 60;  ///< more than the 52 binary digits between two numbers of the same size

/// Halves the bracket that contains the end of a property until close(inside, outside), at most `max_halvings` times,
/// with one call of `holds` each.
template <class Property, class Close>
Bracket bisect(Bracket bracket, const Property& holds, const Close& close, int max_halvings = kMaxHalvings) {
    for (int i = 0; i < max_halvings && !close(bracket.inside, bracket.outside); ++i) {
        const double middle = 0.5 * (bracket.inside + bracket.outside);
        (holds(middle) ? bracket.inside : bracket.outside) = middle;
    }
    return bracket;
}

/// The same with exactly `halvings` halvings.
template <class Property>
Bracket bisect(const Bracket& bracket, const Property& holds, int halvings) {
    return bisect(
        bracket, holds, [](double, double) { return false; }, halvings);
}

/// The same in ln x, both ends > 0, until their ratio is within 1 +- `tolerance`.
template <class Property>
Bracket log_bisect(Bracket bracket, const Property& holds, double tolerance) {
    for (int i = 0; i < kMaxHalvings && std::abs(bracket.inside / bracket.outside - 1) > tolerance; ++i) {
        const double middle = std::sqrt(bracket.inside * bracket.outside);
        (holds(middle) ? bracket.inside : bracket.outside) = middle;
    }
    return bracket;
}

}  // namespace tunewright
