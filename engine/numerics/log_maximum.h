// The largest value of a function of a positive quantity beside a point where it is known to be large. The one place
// that knows Boost.Math's minimisation without derivatives.
#pragma once

#include <functional>

namespace tunewright {

struct Maximum {
    double x = 0;
    double value = 0;  ///< f(x)
};

/// The maximum of f over [left, right], 0 < left < known.x < right, in ln x: Brent's method (Brent, Algorithms for
/// Minimization without Derivatives, 1973, chapter 5). Where f has one maximum there, ln x is good to about 1e-8 and
/// the value to the square of that times f's curvature; in any case the value is not below the known one.
Maximum log_maximum(const std::function<double(double)>& f, double left, const Maximum& known, double right);

}  // namespace tunewright
