// Internal model control's PID on first- and second-order models.
#pragma once

#include "engine/tuning/method/rule.h"

namespace tunewright {

enum class ImcExpansion { maclaurin, pade };

struct ImcOptions {
    std::optional<double> lambda = {};  ///< of the filter; empty: the larger of the dead time and a tenth of the lags
    std::optional<int> filter_order = {};  ///< n, 1 or 2; empty: the model's order
    ImcExpansion expansion = ImcExpansion::maclaurin;
    ReductionOptions reduction = {};
    std::optional<FilterOptions> filter = {};
};

/// C = f/(G- (1 - G+ f)) with f = 1/(lambda s + 1)^n on G = K e^(-Ls)/(1 + n1 s + n2 s^2), one or two lags or an
/// oscillatory pair, as a PID:
///
///     maclaurin  the first three terms of the series of s C about 0, the dead time exact in it
///     pade       the dead time replaced first: by its 1/1 Pade approximation on a first-order model, by 1 - L s on a
///                second-order one; C is then a PID exactly, with a filter on its derivative where n = 2
///
/// Sources: Morari and Zafiriou, Robust Process Control (1989); Rivera, Morari and Skogestad (1986), Table 1 (pade);
/// Liu and Gao (2008), Table 2 (maclaurin with n = 2 on the second-order process).
TuningMethod imc_method();
inline constexpr const char* kImc = "imc";  ///< its id

/// The same without a request.
Expected<TunedController> tune_imc(const TuningProblem& problem, const ImcOptions& options);

}  // namespace tunewright
