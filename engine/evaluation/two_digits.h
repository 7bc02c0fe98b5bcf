// The end of a plot: a round number above the time that must be seen.
#pragma once

#include <cmath>

namespace tunewright {

/// The next number at or above a value > 0 that has two significant digits; 0 for other values.
inline double two_digits_up(double value) {
    if (!(value > 0)) return 0;
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1);
    return std::ceil(value / unit) * unit;
}

}  // namespace tunewright
