#include "engine/tuning/emulation/target.h"

#include <algorithm>
#include <cmath>

#include "engine/number_text.h"
#include "engine/numerics/polynomial_roots.h"

namespace tunewright::emulation {
namespace {

constexpr double kShareOfPlantTime = 0.5;  // the default target's lags over the plant's slowest time
constexpr double kConjugate = 1e-9;        // of a pair, relative

Error wrong(const std::string& where, const std::string& sentence) {
    return {ErrorKind::invalid_argument, where, sentence};
}

std::string cure(int r) {
    if (r == 1) return "Give gamma.";
    if (r == 2) return "Give tau_cl and xi, or two poles.";
    return "Give " + std::to_string(r) + " poles.";
}

Error unsuitable(const std::string& where, const std::string& given, int asked, int r) {
    return wrong(where, given + " is for relative degree " + std::to_string(asked) +
                            "; the plant's relative degree is " + std::to_string(r) + ". " + cure(r));
}

bool paired(const std::vector<std::complex<double>>& poles) {
    return std::ranges::all_of(poles, [&](const auto& p) {
        const auto is_partner = [&](const auto& q) { return std::abs(q - std::conj(p)) <= kConjugate * std::abs(p); };
        return std::ranges::count_if(poles, is_partner) ==
               std::ranges::count_if(poles, [&](const auto& q) { return std::abs(q - p) <= kConjugate * std::abs(p); });
    });
}

Expected<TargetResponse> of_given_poles(int r, const std::vector<std::complex<double>>& poles) {
    for (std::size_t i = 0; i < poles.size(); ++i)
        if (!(poles[i].real() < 0))
            return wrong("target/poles/" + std::to_string(i), "A pole of the target has the real part " +
                                                                  text(poles[i].real()) +
                                                                  "; it must be below 0, for a target that settles.");
    if (static_cast<int>(poles.size()) != r)
        return unsuitable("target/poles", "A target of " + std::to_string(poles.size()) + " poles",
                          static_cast<int>(poles.size()), r);
    if (!paired(poles))
        return wrong("target/poles",
                     "Complex poles of the target must come in conjugate pairs: [re, im] and [re, "
                     "-im].");
    return target_of_poles(poles);
}

TargetResponse by_default(const LinearPlant& plant, int r) {
    const double time = std::max(kShareOfPlantTime * plant_time(plant), plant.dead_time());
    if (r == 1) return first_order_target(time);
    if (r == 2) return second_order_target(time / 2, 1);
    return target_of_poles(std::vector<std::complex<double>>(static_cast<std::size_t>(r), -r / time));
}

}  // namespace

Expected<TargetResponse> chosen_target(const LinearPlant& plant, int r, const TargetOptions& options) {
    const auto &gamma = options.gamma, &tau_cl = options.tau_cl, &xi = options.xi;
    const bool poles = !options.poles.empty();
    if (gamma.has_value() + (tau_cl || xi) + poles > 1)
        return wrong("target", "target must be one of gamma, tau_cl with xi, and poles; more than one is given.");
    if (gamma && r != 1) return unsuitable("target/gamma", "gamma", 1, r);
    if (gamma) return first_order_target(*gamma);
    if (xi && !tau_cl) return wrong("target/tau_cl", "xi is given without tau_cl; give both.");
    if (tau_cl && r != 2) return unsuitable("target/tau_cl", "tau_cl", 2, r);
    if (tau_cl) return second_order_target(*tau_cl, xi.value_or(1));
    if (poles) return of_given_poles(r, options.poles);
    return by_default(plant, r);
}

double target_time(const TargetResponse& target) { return target.beta[1]; }

double slowest_time(const TargetResponse& target) {
    const std::vector<double> descending(target.beta.rbegin(), target.beta.rend());
    double slowest = 0;
    for (const auto& pole : polynomial_roots(descending)) slowest = std::max(slowest, 1 / std::abs(pole.real()));
    return slowest;
}

double plant_time(const LinearPlant& plant) {
    double slowest = 0;
    for (const auto& pole : plant.poles()) slowest = std::max(slowest, 1 / std::abs(pole));
    if (slowest > 0) return slowest;
    return plant.dead_time() > 0 ? 10 * plant.dead_time() : 1;
}

}  // namespace tunewright::emulation
