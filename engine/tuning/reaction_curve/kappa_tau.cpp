#include "engine/tuning/reaction_curve/kappa_tau.h"

#include <algorithm>
#include <cmath>

#include "engine/number_text.h"

namespace tunewright {
namespace {

struct Curve {
    double a0, a1, a2;
    double at(double tau) const { return a0 * std::exp((a1 + a2 * tau) * tau); }
};

struct Row {
    Curve a_Kp, Ti_over_L, Td_over_L, b;
};

constexpr Curve kNone{0, 0, 0};
constexpr Row kPI14{{0.29, -2.7, 3.7}, {8.9, -6.6, 3.0}, kNone, {0.81, 0.73, 1.9}};
constexpr Row kPI20{{0.78, -4.1, 5.7}, {8.9, -6.6, 3.0}, kNone, {0.44, 0.78, -0.45}};
constexpr Row kPID14{{3.8, -8.4, 7.3}, {5.2, -2.5, -1.4}, {0.89, -0.37, -4.1}, {0.40, 0.18, 2.8}};
constexpr Row kPID20{{8.4, -9.6, 9.8}, {3.2, -1.5, -0.93}, {0.86, -1.9, -0.44}, {0.22, 0.65, 0.051}};

IdealPid settings(const Row& row, const ReducedModel& model) {
    const double L = model.L, a = model.K * L / model.T1, tau = normalised_dead_time(model);
    return {.Kp = row.a_Kp.at(tau) / a,
            .Ti = row.Ti_over_L.at(tau) * L,
            .Td = row.Td_over_L.at(tau) * L,
            .b = std::min(1.0, row.b.at(tau))};
}

Expected<TunedController> tune_kappa_tau(const TuningProblem& problem, const KappaTauOptions& options) {
    const bool robust = options.table_Ms == TableMs::Ms_1_4;
    const bool wants_PID = options.controller == ControllerKind::PID;
    const Row& row = wants_PID ? (robust ? kPID14 : kPID20) : (robust ? kPI14 : kPI20);
    return tune_first_order(
        problem, options.model,
        {.name = wants_PID ? "Kappa-tau's PID" : "Kappa-tau's PI", .min = wants_PID ? 0.4 : 0.1, .max = 4},
        [&](const ReducedModel& model) { return settings(row, model); });
}

}  // namespace

TuningMethod kappa_tau_method() {
    TuningMethod method;
    method.id = "kappa_tau";
    method.title = "Kappa-tau";
    method.formula =
        "tau = L/(L + T), a = K L/T; a Kp, Ti/L, Td/L and b: a0 exp(a1 tau + a2 tau^2), each with its a0, a1, a2; "
        "PID, Ms = 1.4: a Kp: 3.8, -8.4, 7.3; Ti/L: 5.2, -2.5, -1.4; Td/L: 0.89, -0.37, -4.1; b: 0.40, 0.18, 2.8; "
        "PID, Ms = 2: a Kp: 8.4, -9.6, 9.8; Ti/L: 3.2, -1.5, -0.93; Td/L: 0.86, -1.9, -0.44; b: 0.22, 0.65, 0.051; "
        "PI, Ms = 1.4: a Kp: 0.29, -2.7, 3.7; Ti/L: 8.9, -6.6, 3.0; b: 0.81, 0.73, 1.9; PI, Ms = 2: a Kp: 0.78, -4.1, "
        "5.7; Ti/L: 8.9, -6.6, 3.0; b: 0.44, 0.78, -0.45";
    method.source = "Åström and Hägglund, PID Controllers: Theory, Design, and Tuning, 2nd edition (1995), section 5.3";
    method.needs = "fopdt with T > 0 and L > 0 (others are reduced)";
    method.validity =
        "plants with an essentially monotone step response; PI: L/T from 0.1 to 4, PID: from 0.4 (below that the loop "
        "of a plant with one lag, unlike those of the source's batch, may be unstable)";
    OptionSet<KappaTauOptions> options;
    add_controller(options, {ControllerKind::PI, ControllerKind::PID});
    options.choice(&KappaTauOptions::table_Ms, "table_Ms", "The Ms for which the table was fitted.",
                   Words<TableMs>{{"1.4", TableMs::Ms_1_4}, {"2.0", TableMs::Ms_2_0}});
    options.embed(&KappaTauOptions::model, first_order_options());
    method.variants = {{"PI, Ms = 1.4", options.given_for({.controller = ControllerKind::PI})},
                       {"PID, Ms = 1.4", {}},
                       {"PID, Ms = 2", options.given_for({.table_Ms = TableMs::Ms_2_0})}};
    method.bind(options, tune_kappa_tau);
    return method;
}

}  // namespace tunewright
