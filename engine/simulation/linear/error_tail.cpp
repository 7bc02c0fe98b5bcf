#include "engine/simulation/linear/error_tail.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tunewright {
namespace {

constexpr double kNone = 1e-10;                                           // of the absolute error's integral
constexpr double kRounding = 8 * std::numeric_limits<double>::epsilon();  // of y: the integral of e has it times t

}  // namespace

void ErrorTail::add(const ResponseNode& a, const ResponseNode& b, double r) {
    const double h = b.t - a.t, ea = std::abs(r - a.y), eb = std::abs(r - b.y);
    largest_ = std::max(largest_, std::abs(b.y));
    absolute_error_ += 0.5 * h * (ea + eb);
    first_moment_ += 0.5 * h * (a.t * ea + b.t * eb);
}

bool ErrorTail::little_is_left(double rest, double e, double t, double fraction) const {
    rest = std::abs(rest);
    e = std::abs(e);
    // e^(-t/tau) has the integral tau and the first moment tau (t + tau) from t on: tau = rest/e.
    return rest <= kNone * absolute_error_ + kRounding * largest_ * t ||
           rest * (t * e + rest) <= fraction * first_moment_ * e;
}

}  // namespace tunewright
