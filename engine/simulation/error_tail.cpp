#include "engine/simulation/error_tail.h"

#include <cmath>

namespace tunewright {
namespace {

constexpr double kRounding = 1e-10;  // of the absolute error's integral: what is left below it is none

}  // namespace

void ErrorTail::add(const ResponseNode& a, const ResponseNode& b, double r) {
    const double h = b.t - a.t, ea = std::abs(r - a.y), eb = std::abs(r - b.y);
    absolute_error_ += 0.5 * h * (ea + eb);
    first_moment_ += 0.5 * h * (a.t * ea + b.t * eb);
}

bool ErrorTail::little_is_left(double rest, double e, double t, double fraction) const {
    rest = std::abs(rest);
    e = std::abs(e);
    // e^(-t/tau) has the integral tau and the first moment tau (t + tau) from t on: tau = rest/e.
    return rest <= kRounding * absolute_error_ || rest * (t * e + rest) <= fraction * first_moment_ * e;
}

}  // namespace tunewright
