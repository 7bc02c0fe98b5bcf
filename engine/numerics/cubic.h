// A cubic polynomial over a step, and what is asked of it.
#pragma once

#include <array>
#include <optional>

namespace tunewright {

/// Taylor coefficients at the beginning of the step: c0 + c1 s + c2 s^2/2 + c3 s^3/6.
using Cubic = std::array<double, 4>;

inline double value_at(const Cubic& c, double s) { return c[0] + s * (c[1] + s * (c[2] / 2 + s * c[3] * (1.0 / 6))); }
inline double slope_at(const Cubic& c, double s) { return c[1] + s * (c[2] + s * c[3] / 2); }

/// A quantity at one instant: its value and its derivative in time.
struct Signal {
    double value = 0, slope = 0;
};

/// The cubic through values and slopes at both ends of a step of length h > 0 (Hermite), its value halfway, its
/// integral over the step.
inline Cubic hermite_taylor(double h, Signal start, Signal end) {
    // The one division needs h alone, which is there before the values are.
    const double inverse = 1 / h, mean_slope = (end.value - start.value) * inverse;
    return {start.value, start.slope, (6 * mean_slope - (4 * start.slope + 2 * end.slope)) * inverse,
            (-12 * mean_slope + 6 * (start.slope + end.slope)) * (inverse * inverse)};
}
inline double hermite_midpoint(double h, Signal start, Signal end) {
    return 0.5 * (start.value + end.value) + h * (start.slope - end.slope) / 8;
}
inline double hermite_integral(double h, Signal start, Signal end) {
    return 0.5 * h * (start.value + end.value) + h * h * (start.slope - end.slope) / 12;
}

/// First s in [0, h] where c rises above 0, if it reaches more than `noise` within the step; located between the
/// turning points to rounding.
std::optional<double> first_rise(const Cubic& c, double h, double noise);

}  // namespace tunewright
