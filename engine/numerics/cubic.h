// A cubic polynomial over a step, with its values, integrals and crossings.
#pragma once

#include <array>
#include <optional>

#include "engine/numerics/registers.h"

namespace tunewright {

/// Taylor coefficients at the beginning of the step: c0 + c1 s + c2 s^2/2 + c3 s^3/6. `Number`: a double, or several
/// side by side in a register.
template <class Number>
using CubicOf = std::array<Number, 4>;
using Cubic = CubicOf<double>;

/// Value and slope at s. Returned by reference: the calling convention for a wide register depends on the processor.
template <class Number>
TUNEWRIGHT_INLINED void evaluate(const CubicOf<Number>& c, double s, Number& value, Number& slope) {
    value = c[0] + s * (c[1] + s * (c[2] / 2 + s * c[3] * (1.0 / 6)));
    slope = c[1] + s * (c[2] + s * c[3] / 2);
}
inline double value_at(const Cubic& c, double s) {
    double value = 0, slope = 0;
    evaluate(c, s, value, slope);
    return value;
}
inline double slope_at(const Cubic& c, double s) {
    double value = 0, slope = 0;
    evaluate(c, s, value, slope);
    return slope;
}

/// A quantity at one instant: its value and its derivative in time.
struct Signal {
    double value = 0, slope = 0;
};

/// The cubic through values and slopes at both ends of a step of length h > 0 (Hermite), its value halfway, its
/// integral over the step.
template <class Number>
TUNEWRIGHT_INLINED CubicOf<Number> hermite_taylor(double h, const Number& start, const Number& start_slope,
                                                  const Number& end, const Number& end_slope) {
    // The only division needs h alone, which is known before the values are.
    const double inverse = 1 / h;
    const Number mean_slope = (end - start) * inverse;
    return {start, start_slope, (6 * mean_slope - (4 * start_slope + 2 * end_slope)) * inverse,
            (-12 * mean_slope + 6 * (start_slope + end_slope)) * (inverse * inverse)};
}
inline Cubic hermite_taylor(double h, Signal start, Signal end) {
    return hermite_taylor(h, start.value, start.slope, end.value, end.slope);
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
