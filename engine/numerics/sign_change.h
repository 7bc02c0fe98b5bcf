// The sign change of a function of one variable between two points. Only its source uses Boost.Math's bracketing root
// finder, algorithm 748 (Alefeld, Potra and Shi, ACM Trans. Math. Softw. 21 (1995) 327-344): four to six evaluations
// for a smooth root, and at most a small multiple of those of a bisection.
//
//   const auto f = [](double x) { return x * x - 2; };
//   const double root = root_between(f, 1, 2, f(1), f(2), 1e-12);   // 1.414213562373
//
// A value that is not finite counts as a very large one of its sign (NaN as positive), so the interval is halved there.
#pragma once

#include <functional>
#include <optional>

namespace tunewright {

/// A point between `a` and `b` (in any order) within `tolerance` > 0 of a change of sign, or at which f is 0. `f_a` and
/// `f_b` are f there: of opposite signs, or one of them 0.
double root_between(const std::function<double(double)>& f, double a, double b, double f_a, double f_b,
                    double tolerance);

/// The same for positive `a` and `b` in ln x: `tolerance` is relative.
double log_root(const std::function<double(double)>& f, double a, double b, double f_a, double f_b, double tolerance);

/// The smallest number found in (low, high] at which f > 0, to rounding. Requires `f_low` <= 0 < `f_high`.
double first_positive(const std::function<double(double)>& f, double low, double high, double f_low, double f_high);

/// The first s in (a, b] at which g, which is not above 0 at a, rises above it; located to rounding. g is also
/// evaluated at `samples` points between a and b, to find an excursion that has ended before b.
std::optional<double> first_crossing(const std::function<double(double)>& g, double a, double b, int samples = 4);

}  // namespace tunewright
