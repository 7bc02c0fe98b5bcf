#include "api/code/parts.h"

namespace tunewright::api {
namespace {

using code::AntiWindup;
using code::Language;

Codec<IntegralRule> integral_rule() {
    return choice<IntegralRule>({{"backward", IntegralRule::backward},
                                 {"forward", IntegralRule::forward},
                                 {"trapezoidal", IntegralRule::trapezoidal}});
}

Codec<DerivativeRule> derivative_rule() {
    return choice<DerivativeRule>({{"difference", DerivativeRule::difference},
                                   {"filtered_backward", DerivativeRule::filtered_backward},
                                   {"filtered_forward", DerivativeRule::filtered_forward},
                                   {"filtered_trapezoidal", DerivativeRule::filtered_trapezoidal},
                                   {"slope", DerivativeRule::slope},
                                   {"four_points", DerivativeRule::four_points}});
}

void check_question(const Json& value, CodeQuestion& question, Reader& reader) {
    const bool slope = question.derivative == DerivativeRule::slope;
    if (slope && !question.slope_samples)
        reader.fault_at("slope_samples",
                        "slope_samples is missing; the rule slope needs the number of sample times that it spans, such "
                        "as 4.");
    if (!slope && question.slope_samples)
        reader.fault_at("slope_samples",
                        "slope_samples belongs to the derivative slope. Choose that rule, or leave it out.");
    if (question.velocity && question.anti_windup)
        reader.fault_at("anti_windup",
                        "anti_windup is given for the velocity form, which winds nothing up: it adds to the limited "
                        "output. Leave it out.");
    if (question.tracking_time && (question.velocity || question.anti_windup == AntiWindup::clamping))
        reader.fault_at("tracking_time",
                        "tracking_time belongs to anti_windup back_calculation. Choose that, or leave it out.");
    if (question.u_min && question.u_max && !(*question.u_min < *question.u_max))
        reader.fault_at("u_max", "u_max is " + shown(value.at("u_max")) + " and u_min " + shown(value.at("u_min")) +
                                     "; u_max must be > u_min.");
}

}  // namespace

const Description<CodeQuestion>& code_contract() {
    static const auto description = [] {
        using Q = CodeQuestion;
        Description<Q> d("CodeQuestion", "What a controller's code is to be like.");
        d.field("language", &Q::language,
                choice<Language>({{"st", Language::structured_text}, {"c", Language::c}, {"python", Language::python}}),
                "st, c or python.", {.required = true})
            .field("sample_time", &Q::sample_time, maybe(number({.exclusive_minimum = 0})), "Time from call to call.",
                   {.unit = "time"})
            .field("integral", &Q::integral, integral_rule(), "Rule of the integral.")
            .field("derivative", &Q::derivative, derivative_rule(), "Rule of the derivative.")
            .field("slope_samples", &Q::slope_samples, maybe(integer(1, code::kMostSlopeSamples)),
                   "Sample times that the rule slope spans.")
            .field("form", &Q::velocity, choice<bool>({{"position", false}, {"velocity", true}}),
                   "Whether u is a sum or what it last was and its increments.")
            .field("anti_windup", &Q::anti_windup,
                   maybe(choice<AntiWindup>(
                       {{"back_calculation", AntiWindup::back_calculation}, {"clamping", AntiWindup::clamping}})),
                   "What the integral does at a limit.")
            .field("tracking_time", &Q::tracking_time, maybe(number({.exclusive_minimum = 0})),
                   "Tracking time of back-calculation.", {.unit = "time"})
            .field("u_min", &Q::u_min, maybe(number()), "Least u.", {.unit = "u"})
            .field("u_max", &Q::u_max, maybe(number()), "Largest u.", {.unit = "u"})
            .field("rate_limit", &Q::rate_limit, maybe(number({.exclusive_minimum = 0})),
                   "Most that u moves in a unit of time.", {.unit = "u/time"})
            .field("bias", &Q::bias, maybe(number()), "u at the operating point.", {.unit = "u"})
            .field("y0", &Q::y0, maybe(number()), "y at the operating point.", {.unit = "y"})
            .check(check_question);
        return d;
    }();
    return description;
}

}  // namespace tunewright::api
