// Where a function of a positive quantity (a frequency, a time constant) passes zero.
#pragma once

#include <functional>

namespace tunewright {

/// Between two points at which f has opposite signs (`f_left`, `f_right`), in ln x: Illinois' false position, bisection
/// where a value is not finite and after 40 steps. Ends when ln x moves by less than `tolerance`.
double log_root(const std::function<double(double)>& f, double left, double right, double f_left, double f_right,
                double tolerance);

}  // namespace tunewright
