#include "engine/tuning/ultimate/tyreus_luyben.h"

#include <cmath>

#include "engine/number_text.h"

namespace tunewright {
namespace {

constexpr double kSmallGainProduct = 0.5;  // 1/(K Ku)

// With an integral time of 2.2 Pu, a plant with a large dead time approaches its set point very slowly.
std::vector<Warning> sluggishness(const TuningProblem& problem, const UltimatePoint& at) {
    const double kappa = std::abs(gain_ratio(problem.linear, at));
    if (kappa <= kSmallGainProduct) return {};
    return {outside_validity("1/(K Ku) is " + text(kappa) +
                             ", above 0.5: the dead time is large, and the rule's integral time is much too long for "
                             "it. The rule was made for lag-dominated and integrating plants; use simc or robust.")};
}

Expected<TunedController> tune_tyreus_luyben(const TuningProblem& problem, const TyreusLuybenOptions& options) {
    const auto at = chosen_ultimate_point(problem, options.point);
    if (!at) return at.error();
    IdealPid answer = options.controller == ControllerKind::PI
                          ? IdealPid{.Kp = at->Ku / 3.2, .Ti = 2.2 * at->Pu}
                          : IdealPid{.Kp = at->Ku / 2.2, .Ti = 2.2 * at->Pu, .Td = at->Pu / 6.3};
    answer.filter = chosen_filter(options.filter, FilterType::derivative, answer.Td);
    std::vector<Warning> warnings = ultimate_warnings(problem);
    for (const auto& warning : sluggishness(problem, *at)) warnings.push_back(warning);
    return rule_answer(answer, std::move(warnings));
}

}  // namespace

TuningMethod tyreus_luyben_method() {
    TuningMethod method;
    method.id = "tyreus_luyben";
    method.title = "Tyreus-Luyben";
    method.formula = "PI: Kp = Ku/3.2, Ti = 2.2 Pu; PID: Kp = Ku/2.2, Ti = 2.2 Pu, Td = Pu/6.3";
    method.source =
        "Tyreus and Luyben, Ind. Eng. Chem. Res. 31 (1992) 2625-2628; PID: Luyben and Luyben, Essentials of Process "
        "Control (1997)";
    method.needs = "any linear plant that oscillates with some proportional gain, or Ku and Pu";
    method.validity = "lag-dominated and integrating plants: 1/(K Ku) up to 0.5";
    OptionSet<TyreusLuybenOptions> options;
    add_controller(options, {ControllerKind::PI, ControllerKind::PID});
    options.embed(&TyreusLuybenOptions::point, ultimate_options());
    add_filter(options, "of the derivative part, Td s/(1 + s Tf); the source has none.");
    method.bind(options, tune_tyreus_luyben);
    return method;
}

}  // namespace tunewright
