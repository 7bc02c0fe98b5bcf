// The revised IMC design on a first-order model with dead time, in closed form.
#pragma once

#include <optional>

#include "engine/controller/imc_controller.h"
#include "engine/plant/plant.h"
#include "engine/tuning/limits.h"
#include "engine/tuning/model_based/imc.h"

namespace tunewright {

/// Filter of the derivative: Tf = Tf_over_Td Td (0: none), or the filter time of the linear fractional approximation.
struct RimcFilter {
    bool linear_fraction = false;
    double Tf_over_Td = limits::kDefaultTf_over_Td;
};

/// Eqs. 19-23 for this model (T > 0, L >= 0) and lambda > 0:
/// beta = tau [1 - (lambda/tau - 1)^2 e^(-theta/tau)].
ImcController rimc_controller(const Fopdt& model, double lambda);

/// Terms of C of Eq. 23, by the series of its denominator (lambda s + 1)^2 - (beta s + 1) e^(-theta s) over s: d0 = 2
/// lambda + theta - beta, d1 = lambda^2 + beta theta - theta^2/2, d2 = theta^3/6 - beta theta^2/2, d3 = beta theta^3/6
/// - theta^4/24.
ImcTerms rimc_terms(const ImcController& controller);

/// Eqs. 25-26 with its filter: Kp = k_c, Ti = k_c tau_i, Td = tau_d/k_c (tau_i is the paper's inverse integral gain,
/// tau_d its derivative gain), b 1, c 0. Empty if K k_c <= 0 or Td < 0, or if the linear fraction has no filter time.
std::optional<IdealPid> rimc_pid(const Fopdt& model, double lambda, const RimcFilter& filter);

}  // namespace tunewright
