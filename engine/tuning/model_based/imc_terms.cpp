#include "engine/tuning/model_based/imc_terms.h"

#include <cmath>

namespace tunewright {
namespace {

constexpr double kRounding = 1e-12;

}  // namespace

ImcTerms imc_terms(double K, double n1, double n2, const std::array<double, 4>& d) {
    const double m0 = 1 / d[0];
    const double m1 = (n1 - d[1] * m0) / d[0];
    double m2 = (n2 - d[1] * m1 - d[2] * m0) / d[0];
    // Its parts can cancel to the last digit, as for a plant without dead time.
    if (std::abs(m2 * d[0]) <= kRounding * (std::abs(n2) + std::abs(d[1] * m1) + std::abs(d[2] * m0))) m2 = 0;
    const double m3 = (-d[1] * m2 - d[2] * m1 - d[3] * m0) / d[0];
    return {m0 / K, m1 / K, m2 / K, m3 / K};
}

Pid maclaurin_pid(const ImcTerms& m) { return {.Kp = m.m1, .Ti = m.m1 / m.m0, .Td = m.m2 / m.m1}; }

std::optional<double> linear_fraction_Tf(const ImcTerms& m) {
    if (m.m2 == 0) return std::nullopt;
    const double Tf = -m.m3 / m.m2;
    return Tf > 0 ? std::optional(Tf) : std::nullopt;
}

}  // namespace tunewright
