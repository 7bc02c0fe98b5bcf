#include "engine/controller/error_scaling.h"

#include "engine/numerics/sign_change.h"

namespace tunewright {
namespace {

constexpr double kLargeArgument = 300;         // beyond it the Bessel functions' asymptote is exact enough
constexpr double kLargestAmplitude = 1e12;     // in delta_r: the gain is below 1e-35 there
constexpr double kAmplitudeTolerance = 1e-13;  // of the bracket's upper end, at most twice the amplitude

}  // namespace

double ErrorScaling::gain_of_amplitude(double A) const {
    const double x = 0.5 * A / delta_r, b = x * x;
    // e^-b (I0 - I1) -> (1 + 3/(8 b))/(2 b sqrt(2 pi b)).
    if (b > kLargeArgument) return (1 + 0.375 / b) / (2 * b * std::sqrt(2 * std::numbers::pi * b));
    return std::exp(-b) * (std::cyl_bessel_i(0.0, b) - std::cyl_bessel_i(1.0, b));
}

double ErrorScaling::amplitude_of_gain(double k) const {
    const auto surplus = [&](double A) { return gain_of_amplitude(A) - k; };
    double high = delta_r, at_high = surplus(high);
    while (at_high > 0 && high < kLargestAmplitude * delta_r) at_high = surplus(high *= 2);
    return root_between(surplus, 0, high, 1 - k, at_high, kAmplitudeTolerance * high);
}

}  // namespace tunewright
