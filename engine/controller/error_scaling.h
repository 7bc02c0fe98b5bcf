// What the nonlinear PID's integral is fed with in place of the error e.
#pragma once

#include <cmath>
#include <numbers>

namespace tunewright {

/// phi(e) = exp(-e^2/(2 delta_r^2)) e. Jin & Son (2019), Eqs. 3 and 5. Largest at e = delta_r; phi(e)/e lies in (0, 1].
struct ErrorScaling {
    double delta_r = 1;  ///< > 0, in units of y

    /// phi(e) - e.
    double excess(double e) const { return std::expm1(-exponent(e)) * e; }
    /// d(phi - e)/de.
    double excess_slope(double e) const {
        const double a = exponent(e);
        return std::expm1(-a) - 2 * a * std::exp(-a);
    }

    /// The describing function, the gain for a sine of this amplitude: e^-b (I0(b) - I1(b)), b = (A/(2 delta_r))^2.
    double gain_of_amplitude(double A) const;
    /// The amplitude A > 0 whose gain is k, 0 < k < 1.
    double amplitude_of_gain(double k) const;

private:
    double exponent(double e) const {
        const double x = e / delta_r;
        return 0.5 * x * x;
    }
};

}  // namespace tunewright
