// Internal model control's controller as a series: what a PID can take over of it.
#pragma once

#include <array>
#include <optional>

#include "engine/controller/pid.h"

namespace tunewright {

/// The first terms of M(s) = s C(s) = m0 + m1 s + m2 s^2 + m3 s^3 + ...
struct ImcTerms {
    double m0 = 0, m1 = 0, m2 = 0, m3 = 0;
};

/// Of C = (1 + n1 s + n2 s^2)/(K s (d[0] + d[1] s + d[2] s^2 + d[3] s^3 + ...)), by division of the series. d[0] != 0.
/// An m2 that is nothing but rounding errors is 0.
ImcTerms imc_terms(double K, double n1, double n2, const std::array<double, 4>& d);

/// The first three terms as a PID: Kp = m1, Ti = m1/m0, Td = m2/m1 (Liu and Gao 2008, Eq. 26). No filter.
Pid maclaurin_pid(const ImcTerms& terms);

/// The filter time that matches the fourth term too: C = (a0 + a1 s + a2 s^2)/(s (1 + Tf s)) with Tf = -m3/m2 has the
/// gains of maclaurin_pid and its derivative filtered by Tf. Empty where there is none (Tf <= 0 or Td = 0).
std::optional<double> linear_fraction_Tf(const ImcTerms& terms);

}  // namespace tunewright
