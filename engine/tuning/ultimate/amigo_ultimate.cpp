#include "engine/tuning/ultimate/amigo_ultimate.h"

#include <cmath>

#include "engine/number_text.h"

namespace tunewright {
namespace {

IdealPid settings(ControllerKind controller, double kappa, const UltimatePoint& at) {
    if (controller == ControllerKind::PI) return {.Kp = 0.16 * at.Ku, .Ti = at.Pu / (1 + 4.5 * kappa)};
    return {.Kp = (0.3 - 0.1 * std::pow(kappa, 4)) * at.Ku,
            .Ti = 0.6 * at.Pu / (1 + 2 * kappa),
            .Td = 0.15 * at.Pu * (1 - kappa) / (1 - 0.95 * kappa)};
}

Expected<TunedController> tune_amigo_ultimate(const TuningProblem& problem, const AmigoUltimateOptions& options) {
    const auto at = chosen_ultimate_point(problem, options.point);
    if (!at) return at.error();
    const LinearPlant& plant = problem.linear;
    const double kappa = gain_ratio(plant, *at);
    if (plant.unstable_poles() > 0 || !(kappa >= 0 && kappa <= 1))
        return Error{ErrorKind::unsupported, "plant",
                     "The rule needs a stable or integrating plant whose gain at its ultimate point is at most the "
                     "static gain; 1/(K Ku) is " +
                         text(kappa) + ". Use amigo, ziegler_nichols_ultimate or robust."};
    IdealPid answer = settings(options.controller, kappa, *at);
    answer.filter = chosen_filter(options.filter, FilterType::measurement_second_order, answer.Td);
    std::vector<Warning> warnings;
    if (options.controller == ControllerKind::PID && kappa < 0.1)
        warnings.push_back(outside_validity("1/(K Ku) is " + text(kappa) +
                                            ", below 0.1: plants with so little dead time are poorly described by the "
                                            "ultimate point, and the rule may miss its aim. Check Ms, or use robust."));
    return rule_answer(answer, std::move(warnings));
}

}  // namespace

TuningMethod amigo_ultimate_method() {
    TuningMethod method;
    method.id = "amigo_ultimate";
    method.title = "AMIGO, ultimate gain";
    method.formula =
        "kappa = 1/(K Ku), 0 when integrating; PI: Kp = 0.16 Ku, Ti = Pu/(1 + 4.5 kappa); PID: Kp = (0.3 - 0.1 "
        "kappa^4) Ku, Ti = 0.6 Pu/(1 + 2 kappa), Td = 0.15 Pu (1 - kappa)/(1 - 0.95 kappa)";
    method.source = "Åström and Hägglund, J. Process Control 14 (2004) 635-650; Advanced PID Control (2006), chapter 7";
    method.needs = "stable or integrating plants that oscillate with some proportional gain, or Ku and Pu";
    method.validity = "plants with an essentially monotone step response; PID: kappa from 0.1 to 1";
    OptionSet<AmigoUltimateOptions> options;
    add_controller(options, {ControllerKind::PI, ControllerKind::PID});
    options.embed(&AmigoUltimateOptions::point, ultimate_options());
    add_filter(options, "second order on the measurement, as in the source.");
    method.bind(options, tune_amigo_ultimate);
    return method;
}

}  // namespace tunewright
