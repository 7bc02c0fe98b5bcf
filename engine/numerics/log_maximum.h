// The largest value of a function of a positive quantity beside a point where it is known to be large.
#pragma once

#include <functional>

namespace tunewright {

struct Maximum {
    double x = 0;
    double value = 0;  ///< f(x)
};

/// A maximum of f over [left, right], 0 < left < known.x < right, in ln x: Brent's method (Brent, Algorithms for
/// Minimization without Derivatives, 1973, chapter 5) from the known point on, which is not below both ends. ln x is
/// good to about 1e-8, the value to the square of that times f's curvature. The value is never below the known one.
Maximum log_maximum(const std::function<double(double)>& f, double left, const Maximum& known, double right);

}  // namespace tunewright
