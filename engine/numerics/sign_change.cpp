#include "engine/numerics/sign_change.h"

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

namespace tunewright {
namespace {

constexpr double kRelativeRootTolerance =
    2 * std::numeric_limits<double>::epsilon();  // of a root: nearly neighbouring numbers
constexpr double kMaxValue = 1e100;              // of a value: differences and quotients of two such values are finite
constexpr std::uintmax_t kMaxEvaluations = 200;

double finite(double value) { return value < -kMaxValue ? -kMaxValue : value < kMaxValue ? value : kMaxValue; }

/// Ends of an interval that contains a change of sign and satisfies `is_short`; equal where f is 0.
template <class Function, class IsShort>
std::pair<double, double> enclose(const Function& f, double a, double b, double f_a, double f_b,
                                  const IsShort& is_short) {
    if (f_a == 0) return {a, a};
    if (f_b == 0) return {b, b};
    if (a > b) {
        std::swap(a, b);
        std::swap(f_a, f_b);
    }
    if (!(a < b) || (f_a < 0) == (f_b < 0)) return {b, b};  // no sign change
    auto evaluations = kMaxEvaluations;
    return boost::math::tools::toms748_solve([&](double x) { return finite(f(x)); }, a, b, finite(f_a), finite(f_b),
                                             is_short, evaluations);
}

}  // namespace

double root_between(const std::function<double(double)>& f, double a, double b, double f_a, double f_b,
                    double tolerance) {
    const auto [low, high] =
        enclose(f, a, b, f_a, f_b, [tolerance](double left, double right) { return right - left <= tolerance; });
    return 0.5 * (low + high);
}

double log_root(const std::function<double(double)>& f, double a, double b, double f_a, double f_b, double tolerance) {
    return std::exp(
        root_between([&f](double x) { return f(std::exp(x)); }, std::log(a), std::log(b), f_a, f_b, tolerance));
}

double first_positive(const std::function<double(double)>& f, double low, double high, double f_low, double f_high) {
    // 0 counts as just below it, so that the search ends between two numbers and not at a zero.
    const auto below_at_zero = [](double value) { return value == 0 ? -std::numeric_limits<double>::min() : value; };
    const auto is_short = [](double left, double right) {
        return right - left <= kRelativeRootTolerance * std::max(std::abs(left), std::abs(right));
    };
    return enclose([&](double x) { return below_at_zero(f(x)); }, low, high, below_at_zero(std::min(f_low, 0.0)),
                   f_high, is_short)
        .second;
}

std::optional<double> first_crossing(const std::function<double(double)>& g, double a, double b, int samples) {
    double low = a;
    for (int i = 1; i <= samples + 1; ++i) {
        const double high = i > samples ? b : a + (b - a) * i / (samples + 1);
        const double g_high = g(high);
        if (g_high > 0) return first_positive(g, low, high, g(low), g_high);
        low = high;
    }
    return std::nullopt;
}

}  // namespace tunewright
