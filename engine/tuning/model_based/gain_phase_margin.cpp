#include "engine/tuning/model_based/gain_phase_margin.h"

#include <cmath>
#include <numbers>
#include <optional>

#include "engine/number_text.h"
#include "engine/tuning/method/first_order_rule.h"

namespace tunewright {
namespace {

constexpr double kPi = std::numbers::pi;

SeriesPid settings(const ReducedModel& model, const GainPhaseMarginOptions& margins) {
    const double Am = margins.gain_margin, phi = margins.phase_margin_deg * kPi / 180, L = model.L;
    const double omega = (Am * phi + 0.5 * kPi * Am * (Am - 1)) / ((Am * Am - 1) * L);
    return {.Kp = omega * model.T1 / (Am * model.K),
            .Ti = 1 / (2 * omega - 4 * omega * omega * L / kPi + 1 / model.T1),
            .Td = model.T2};
}

Error contradiction(const GainPhaseMarginOptions& margins) {
    return {ErrorKind::invalid_argument, "phase_margin_deg",
            "A gain margin of " + text(margins.gain_margin) + " with a phase margin of " +
                text(margins.phase_margin_deg) +
                " degrees needs a negative integral time on this model. Choose a phase margin closer to 90 (1 - "
                "1/gain_margin) = " +
                text(90 * (1 - 1 / margins.gain_margin)) + " degrees."};
}

Expected<TunedController> tune_gain_phase_margin(const TuningProblem& problem, const GainPhaseMarginOptions& options) {
    const bool wants_PID = options.controller == ControllerKind::PID;
    const auto model = half_rule_model(problem, options.reduction, options.controller);
    if (!model) return model.error();
    if (const auto error = unfit(*model, {.name = "Ho, Hang and Cao's rule"})) return *error;
    const SeriesPid series = settings(*model, options);
    if (!(series.Ti > 0)) return contradiction(options);

    auto ideal = to_ideal(series);
    if (!ideal) return ideal.error();
    ideal->b = 1;
    ideal->filter = chosen_filter(options.filter, FilterType::derivative, ideal->Td);
    std::vector<Warning> warnings;
    if (wants_PID && series.Td == 0) warnings.push_back(no_second_lag());
    return rule_answer(problem, *model, *ideal, std::move(warnings));
}

}  // namespace

TuningMethod gain_phase_margin_method() {
    TuningMethod method;
    method.id = "gain_phase_margin";
    method.title = "Ho-Hang-Cao, gain and phase margin";
    method.formula =
        "omega_p = (Am phi + pi Am (Am - 1)/2)/((Am^2 - 1) L); series form: Kp = omega_p T1/(Am K), Ti = 1/(2 omega_p "
        "- 4 omega_p^2 L/pi + 1/T1), Td = T2; converted to the ideal form";
    method.source = "Ho, Hang and Cao, Automatica 31 (1995) 497-502";
    method.needs = "fopdt for PI, sopdt for PID, T > 0, L > 0 (others are reduced)";
    method.validity = "the margins are accurate to some percent for L/T below about 2";
    OptionSet<GainPhaseMarginOptions> options;
    add_controller(options, {ControllerKind::PI, ControllerKind::PID});
    options.field(&GainPhaseMarginOptions::gain_margin, "gain_margin", "Specified gain margin.",
                  {.exclusive_minimum = 1, .maximum = 20});
    options.field(&GainPhaseMarginOptions::phase_margin_deg, "phase_margin_deg", "Specified phase margin, in degrees.",
                  {.unit = "deg", .exclusive_minimum = 0, .maximum = 89});
    options.slider("gain_margin").slider("phase_margin_deg");
    add_reduction(options, "half_rule; tangent (first order: PI) if that does not apply.");
    add_filter(options, "of the derivative part of the ideal form, Td s/(1 + s Tf).");
    method.bind(options, tune_gain_phase_margin);
    return method;
}

}  // namespace tunewright
