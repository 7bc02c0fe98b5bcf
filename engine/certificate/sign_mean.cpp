#include "engine/certificate/sign_mean.h"

#include <cstddef>

namespace tunewright::certificate {

std::vector<Interval> jackson_factors(int K) {
    const auto count = static_cast<std::size_t>(K);
    std::vector<Interval> weight(count), factors(count);
    for (std::size_t v = 0; v < count; ++v)
        weight[v] = sine(Interval::pi() * Interval(static_cast<double>(v + 1)) / Interval(static_cast<double>(K + 1)));
    for (std::size_t m = 0; m < count; ++m) {
        Interval sum(0);
        for (std::size_t v = 0; v + m < count; ++v) sum = sum + weight[v] * weight[v + m];
        factors[m] = m == 0 ? sum : sum / factors[0];
    }
    factors[0] = Interval(1);
    return factors;
}

std::vector<Interval> mean_coefficients(const SignFunction& sign, const std::vector<Interval>& factors) {
    std::vector<Interval> a(factors.size());
    for (std::size_t m = 0; m < factors.size(); ++m) {
        // The integral of the sign times cos(m x) from 0 to pi: each change counts twice.
        const Interval order(static_cast<double>(m));
        Interval integral(0);
        double now = sign.first;
        for (const double x : sign.changes) {
            integral = integral + Interval(2 * now) * (m == 0 ? Interval(x) : sine(order * Interval(x)));
            now = -now;
        }
        if (m == 0) integral = integral + Interval(now) * Interval::pi();
        a[m] = m == 0 ? integral / Interval::pi() : factors[m] * Interval(2) * integral / (Interval::pi() * order);
    }
    return a;
}

}  // namespace tunewright::certificate
