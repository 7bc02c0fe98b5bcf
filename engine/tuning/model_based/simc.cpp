#include "engine/tuning/model_based/simc.h"

#include <algorithm>
#include <limits>

#include "engine/number_text.h"

namespace tunewright {
namespace {

// Table 1 of the source; theta is L, tau_1 and tau_2 are T1 and T2, k' = K/T1 is K itself for an integrating plant.
SeriesPid series(const ReducedModel& model, double tau_c) {
    const double horizon = tau_c + model.L;
    SeriesPid pid{.Ti = 4 * horizon, .Td = model.T2};
    if (model.integrators == 2) {
        pid.Kp = 1 / (4 * model.K * horizon * horizon);
        pid.Td = 4 * horizon;
    } else if (model.integrators == 1) {
        pid.Kp = 1 / (model.K * horizon);
        pid.Td = model.T1;
    } else {
        pid.Kp = model.T1 / (model.K * horizon);
        pid.Ti = std::min(model.T1, 4 * horizon);
    }
    return pid;
}

std::vector<Warning> remarks(const ReducedModel& model, double tau_c, const SeriesPid& pid, bool wants_PID) {
    std::vector<Warning> warnings;
    if (tau_c < model.L)
        warnings.push_back(outside_validity("tau_c = " + text(tau_c) +
                                            " is below the effective dead time L = " + text(model.L) +
                                            ", which is smaller than the source recommends: Ms will exceed about "
                                            "1.6."));
    if (!wants_PID) return warnings;
    if (pid.Td == 0)
        warnings.push_back(
            {"no-derivative",
             "The model has no second lag, and without one SIMC has no derivative action: the result is a PI "
             "controller."});
    else if (model.integrators == 0 && model.T2 < model.L)
        warnings.push_back(outside_validity("The second lag T2 = " + text(model.T2) +
                                            " is below the effective dead time L = " + text(model.L) +
                                            ", for which the source recommends PI, because derivative action gains "
                                            "little."));
    return warnings;
}

std::optional<Error> unfit(const ReducedModel& model, double tau_c) {
    if (tau_c + model.L <= 0)
        return degenerate("plant/L",
                          "SIMC divides by tau_c + L, but the effective dead time, which is the default of "
                          "tau_c, is 0.",
                          "Give tau_c, the closed-loop time constant that you want.");
    if (model.integrators == 0 && model.T1 <= 0)
        return degenerate("plant/T",
                          "The model is a pure dead time (T = 0), for which SIMC gives pure integral action, which the "
                          "ideal form cannot represent.",
                          "Use amigo or robust.");
    return std::nullopt;
}

Expected<TunedController> tune_simc(const TuningProblem& problem, const SimcOptions& options) {
    const bool wants_PID = options.controller == ControllerKind::PID;
    const auto model = half_rule_model(problem, options.reduction, options.controller);
    if (!model) return model.error();
    const double tau_c = options.tau_c.value_or(model->L);
    if (const auto error = unfit(*model, tau_c)) return *error;

    const SeriesPid settings = series(*model, tau_c);
    auto ideal = to_ideal(settings);
    if (!ideal) return ideal.error();
    ideal->b = 1;  // the source gives no weight, and its series form is not meant to imply one
    ideal->filter = chosen_filter(options.filter, FilterType::derivative, ideal->Td);
    std::vector<Warning> warnings = remarks(*model, tau_c, settings, wants_PID);
    return rule_answer(problem, *model, *ideal, std::move(warnings));
}

}  // namespace

TuningMethod simc_method() {
    TuningMethod method;
    method.id = "simc";
    method.title = "SIMC (Skogestad)";
    method.formula =
        "series form Kp (1 + 1/(s Ti)) (1 + s Td): Kp = T1/(K (tau_c + L)), Ti = min(T1, 4 (tau_c + L)), Td "
        "= T2; "
        "integrating with lag T: Kp = 1/(K (tau_c + L)), Ti = 4 (tau_c + L), Td = T; "
        "double integrating: Kp = 1/(4 K (tau_c + L)^2), Ti = Td = 4 (tau_c + L); converted exactly to the ideal form";
    method.source = "Skogestad, J. Process Control 13 (2003) 291-309, Table 1";
    method.needs = "fopdt for PI, sopdt for PID, ipdt (others are reduced)";
    method.validity = "tau_c >= L; PID if the second lag exceeds the effective dead time";
    OptionSet<SimcOptions> options;
    add_controller(options, {ControllerKind::PI, ControllerKind::PID});
    options.field(&SimcOptions::tau_c, "tau_c",
                  "Desired closed-loop time constant: larger is slower and more robust. Default: the model's dead time "
                  "L (tight but robust, Ms about 1.6).",
                  {.unit = "time", .exclusive_minimum = 0});
    options.main({"tau_c"}).slider("tau_c");
    add_reduction(options, "half_rule, as in the source; tangent (first order: PI) if that does not apply.");
    add_filter(options, "of the derivative part of the ideal form, Td s/(1 + s Tf).");
    method.bind(options, tune_simc);
    return method;
}

}  // namespace tunewright
