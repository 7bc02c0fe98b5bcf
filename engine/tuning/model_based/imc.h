// The PID of internal model control on first- and second-order models. It consists of the first terms of the
// controller's series.

#pragma once

#include <array>
#include <optional>

#include "engine/controller/pid.h"
#include "engine/tuning/method/rule.h"

namespace tunewright {

enum class ImcExpansion { maclaurin, pade };

struct ImcOptions {
    std::optional<double> lambda = {};  ///< lambda of the filter; empty: the larger of the dead time and a tenth of the
                                        ///< lags
    std::optional<int> filter_order = {};  ///< n, 1 or 2; empty: the model's order
    ImcExpansion expansion = ImcExpansion::maclaurin;
    ReductionOptions reduction = {};
    std::optional<FilterOptions> filter = {};
};

/// C = f/(G- (1 - G+ f)) with f = 1/(lambda s + 1)^n on G = K e^(-Ls)/(1 + n1 s + n2 s^2), one or two lags or an
/// oscillatory pair, as a PID:
///
///     maclaurin  the first three terms of the series of s C about 0, with the exact dead time
///     pade       the dead time is first replaced: by its 1/1 Pade approximation on a first-order model, by 1 - L s on
///                a second-order one; C is then exactly a PID, with a filter on its derivative if n = 2
///
/// Sources: Morari and Zafiriou, Robust Process Control (1989); Rivera, Morari and Skogestad (1986), Table 1 (pade);
/// Liu and Gao (2008), Table 2 (maclaurin with n = 2 on the second-order process).
TuningMethod imc_method();
inline constexpr const char* kImc = "imc";  ///< its id

/// The same for given options, without a request.
Expected<TunedController> tune_imc(const TuningProblem& problem, const ImcOptions& options);

/// The first terms of M(s) = s C(s) = m0 + m1 s + m2 s^2 + m3 s^3 + ...
struct ImcTerms {
    double m0 = 0, m1 = 0, m2 = 0, m3 = 0;
};

/// The terms for C = (1 + n1 s + n2 s^2)/(K s (d[0] + d[1] s + d[2] s^2 + d[3] s^3 + ...)), by division of the series.
/// d[0] != 0. An m2 that consists only of rounding errors is set to 0.
ImcTerms imc_terms(double K, double n1, double n2, const std::array<double, 4>& d);

/// The first three terms as a PID: Kp = m1, Ti = m1/m0, Td = m2/m1 (Liu and Gao 2008, Eq. 26). No filter.
IdealPid maclaurin_pid(const ImcTerms& terms);

/// The filter time that matches the fourth term too: C = (a0 + a1 s + a2 s^2)/(s (1 + Tf s)) with Tf = -m3/m2 has the
/// gains of maclaurin_pid and its derivative filtered by Tf. Empty if there is none (Tf <= 0 or Td = 0).
std::optional<double> linear_fraction_Tf(const ImcTerms& terms);

}  // namespace tunewright
