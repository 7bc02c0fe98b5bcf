#include "engine/tuning/rimc/rimc_design.h"

#include <cmath>

namespace tunewright {

ImcController rimc_controller(const Fopdt& model, double lambda) {
    const double tau = model.T, x = lambda / tau - 1;
    return {.kp = model.K,
            .tau = tau,
            .theta = model.L,
            .lambda = lambda,
            .beta = tau * (1 - x * x * std::exp(-model.L / tau))};
}

ImcTerms rimc_terms(const ImcController& c) {
    const double lambda = c.lambda, theta = c.theta, tau = c.tau, x = lambda / tau - 1;
    // 2 lambda + theta - beta without the cancellation of its large parts.
    const double d0 = lambda * lambda / tau + theta + tau * x * x * std::expm1(-theta / tau);
    return imc_terms(
        c.kp, c.beta + tau, c.beta * tau,
        {d0, lambda * lambda + c.beta * theta - theta * theta / 2, std::pow(theta, 3) / 6 - c.beta * theta * theta / 2,
         c.beta * std::pow(theta, 3) / 6 - std::pow(theta, 4) / 24});
}

std::optional<IdealPid> rimc_pid(const Fopdt& model, double lambda, const RimcFilter& filter) {
    const ImcTerms terms = rimc_terms(rimc_controller(model, lambda));
    IdealPid pid = maclaurin_pid(terms);
    if (!(model.K * pid.Kp > 0) || !(pid.Ti > 0) || !(pid.Td >= 0)) return std::nullopt;
    if (pid.Td == 0) return pid;
    const auto Tf = filter.linear_fraction ? linear_fraction_Tf(terms) : std::optional(filter.Tf_over_Td * pid.Td);
    if (!Tf) return std::nullopt;
    if (*Tf > 0) pid.filter = {FilterType::derivative, *Tf};
    return pid;
}

}  // namespace tunewright
