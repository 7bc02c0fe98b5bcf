#include "engine/tuning/ultimate/ziegler_nichols_ultimate.h"

#include <cmath>

#include "engine/number_text.h"

namespace tunewright {
namespace {

Words<ZieglerNicholsVariant> variants() {
    using enum ZieglerNicholsVariant;
    return {
        {"classic", classic}, {"pessen", pessen}, {"some_overshoot", some_overshoot}, {"no_overshoot", no_overshoot}};
}

IdealPid pid(ZieglerNicholsVariant variant, double Ku, double Pu) {
    using enum ZieglerNicholsVariant;
    if (variant == pessen) return {.Kp = 0.7 * Ku, .Ti = 0.4 * Pu, .Td = 0.15 * Pu};
    if (variant == some_overshoot) return {.Kp = Ku / 3, .Ti = Pu / 2, .Td = Pu / 3};
    if (variant == no_overshoot) return {.Kp = 0.2 * Ku, .Ti = Pu / 2, .Td = Pu / 3};
    return {.Kp = 0.6 * Ku, .Ti = Pu / 2, .Td = Pu / 8};
}

IdealPid settings(ControllerKind controller, ZieglerNicholsVariant variant, const UltimatePoint& at) {
    if (controller == ControllerKind::P) return {.Kp = 0.5 * at.Ku};
    if (controller == ControllerKind::PI) return {.Kp = 0.45 * at.Ku, .Ti = at.Pu / 1.2};
    return pid(variant, at.Ku, at.Pu);
}

// Hang, Åström and Ho's range of K Ku; for an integrating plant K Ku is infinite, and the rule applies to it.
std::vector<Warning> remarks(const TuningProblem& problem, const UltimatePoint& at) {
    std::vector<Warning> warnings = ultimate_warnings(problem);
    const double ratio = std::abs(1 / gain_ratio(problem.linear, at));
    if (!warnings.empty() || problem.linear.integrators() > 0 || (ratio >= 2.25 && ratio <= 15)) return warnings;
    return {outside_validity("K Ku is " + text(ratio) + ", outside the usual range 2.25 to 15 of this rule: " +
                             (ratio < 2.25 ? "with so much dead time it is sluggish, and its PID is close to "
                                             "instability."
                                           : "it is oscillatory and needs very high gains there."))};
}

}  // namespace

Expected<TunedController> tune_ziegler_nichols_ultimate(const TuningProblem& problem,
                                                        const ZieglerNicholsUltimateOptions& options) {
    if (options.controller != ControllerKind::PID && options.variant != ZieglerNicholsVariant::classic)
        return Error{
            ErrorKind::invalid_argument, "variant",
            "variant is " + word_of(variants(), options.variant) + ", which exists only for PID, but controller is " +
                word_of(words_of({options.controller}), options.controller) + ". Omit variant, or choose PID."};
    const auto point = chosen_ultimate_point(problem, options.point);
    if (!point) return point.error();
    IdealPid answer = settings(options.controller, options.variant, *point);
    answer.filter = chosen_filter(options.filter, FilterType::derivative, answer.Td);
    return rule_answer(answer, remarks(problem, *point));
}

TuningMethod ziegler_nichols_ultimate_method() {
    TuningMethod method;
    method.id = kZieglerNicholsUltimate;
    method.title = "Ziegler-Nichols, ultimate gain";
    method.formula =
        "P: Kp = 0.5 Ku; PI: Kp = 0.45 Ku, Ti = Pu/1.2; PID: Kp = 0.6 Ku, Ti = Pu/2, Td = Pu/8; pessen: Kp = 0.7 "
        "Ku, Ti = 0.4 Pu, Td = 0.15 Pu; some_overshoot: Kp = Ku/3, Ti = Pu/2, Td = Pu/3; no_overshoot: Kp = 0.2 "
        "Ku, Ti = Pu/2, Td = Pu/3";
    method.source =
        "Ziegler and Nichols, Trans. ASME 64 (1942) 759-768; Pessen, J. Dyn. Syst. Meas. Control 116 (1994)";
    method.needs = "any linear plant that oscillates with some proportional gain, or Ku and Pu";
    method.validity =
        "integrating plants, stable ones with K Ku from 2.25 to 15; aims at quarter-amplitude damping, so expect Ms "
        "above 2";
    OptionSet<ZieglerNicholsUltimateOptions> options;
    add_controller(options, {ControllerKind::P, ControllerKind::PI, ControllerKind::PID});
    options.choice(
        &ZieglerNicholsUltimateOptions::variant, "variant",
        "Variant of the PID: classic; pessen (Pessen's integral rule); some_overshoot, no_overshoot: less gain, more "
        "damping.",
        variants());
    options.embed(&ZieglerNicholsUltimateOptions::point, ultimate_options());
    add_filter(options, "of the derivative part, Td s/(1 + s Tf); the source has none.");
    // Only the variant with the least overshoot: the others are known for their overshoot.
    method.variants = {{"PI", options.given_for({.controller = ControllerKind::PI})},
                       {"PID", {}},
                       {"PID, no overshoot", options.given_for({.variant = ZieglerNicholsVariant::no_overshoot})}};
    method.bind(options, tune_ziegler_nichols_ultimate);
    return method;
}

}  // namespace tunewright
