#include "engine/controller/error_scaling.h"

namespace tunewright {
namespace {

constexpr double kLargeArgument = 300;  // beyond it the Bessel functions' asymptote is exact enough

}  // namespace

double ErrorScaling::gain_of_amplitude(double A) const {
    const double x = 0.5 * A / delta_r, b = x * x;
    // e^-b (I0 - I1) -> (1 + 3/(8 b))/(2 b sqrt(2 pi b)).
    if (b > kLargeArgument) return (1 + 0.375 / b) / (2 * b * std::sqrt(2 * std::numbers::pi * b));
    return std::exp(-b) * (std::cyl_bessel_i(0.0, b) - std::cyl_bessel_i(1.0, b));
}

double ErrorScaling::amplitude_of_gain(double k) const {
    double low = 0, high = delta_r;
    while (gain_of_amplitude(high) > k && high < 1e12 * delta_r) high *= 2;
    for (int i = 0; i < 100 && high - low > 1e-12 * high; ++i) {
        const double middle = 0.5 * (low + high);
        (gain_of_amplitude(middle) > k ? low : high) = middle;
    }
    return high;
}

}  // namespace tunewright
