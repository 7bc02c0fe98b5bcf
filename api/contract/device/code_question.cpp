#include "api/contract/device/code_question.h"

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
                        "anti_windup is given for the velocity form, which does not wind up because it adds to the "
                        "limited output. Leave it out.");
    if (question.tracking_time && (question.velocity || question.anti_windup == AntiWindup::clamping))
        reader.fault_at("tracking_time",
                        "tracking_time belongs to anti_windup back_calculation. Choose that, or leave it out.");
    const auto ordered = [&](const std::string& low, const std::optional<double>& least, const std::string& high,
                             const std::optional<double>& largest) {
        if (least && largest && !(*least < *largest))
            reader.fault_at(high, high + " is " + shown(value.at(high)) + " and " + low + " " + shown(value.at(low)) +
                                      "; " + high + " must be > " + low + ".");
    };
    ordered("u_min", question.u_min, "u_max", question.u_max);
    ordered("r2_min", question.r2_min, "r2_max", question.r2_max);
}

/// Sizes by name.
Codec<std::map<std::string, double>> sizes() {
    auto codec = numbers_by_name("Name of an input.");
    codec.read = [](const Json& value, std::map<std::string, double>& target, Reader& reader) {
        if (!value.is_object()) return reader.fault("steps must be an object such as {\"setpoint\": 5}.");
        for (const auto& [name, size] : value.items()) {
            const Reader::At at(reader, name);
            if (const auto number = read_number(size, {}, reader)) target[name] = *number;
        }
    };
    codec.skip = [](const auto& steps) { return steps.empty(); };
    return codec;
}

template <class Asked>
void add_rules(Description<Asked>& d) {
    d.field("sample_time", &Asked::sample_time, maybe(number({.exclusive_minimum = 0})),
            "Time from one call to the next.", {.unit = "time"})
        .field("integral", &Asked::integral, integral_rule(), "Rule of the integral.")
        .field("derivative", &Asked::derivative, derivative_rule(), "Rule of the derivative.")
        .field("slope_samples", &Asked::slope_samples, maybe(integer(1, code::kMaxSlopeSamples)),
               "Number of sample times that the rule slope spans.")
        .field("form", &Asked::velocity, choice<bool>({{"position", false}, {"velocity", true}}),
               "position: u is a sum; velocity: the last u plus its increment.")
        .field("anti_windup", &Asked::anti_windup,
               maybe(choice<AntiWindup>(
                   {{"back_calculation", AntiWindup::back_calculation}, {"clamping", AntiWindup::clamping}})),
               "Behaviour of the integral at a limit.")
        .field("tracking_time", &Asked::tracking_time, maybe(number({.exclusive_minimum = 0})),
               "Tracking time of back-calculation.", {.unit = "time"})
        .field("u_min", &Asked::u_min, maybe(number()), "Least u.", {.unit = "u"})
        .field("u_max", &Asked::u_max, maybe(number()), "Largest u.", {.unit = "u"})
        .field("rate_limit", &Asked::rate_limit, maybe(number({.exclusive_minimum = 0})),
               "Largest change of u per unit of time.", {.unit = "u/time"})
        .field("bias", &Asked::bias, maybe(number()), "u at the operating point.", {.unit = "u"})
        .field("y0", &Asked::y0, maybe(number()), "y at the operating point.", {.unit = "y"})
        .field("r2_min", &Asked::r2_min, maybe(number()), "Cascade: least set point of the inner loop.", {.unit = "y"})
        .field("r2_max", &Asked::r2_max, maybe(number()), "Cascade: its largest.", {.unit = "y"})
        .field("r2_bias", &Asked::r2_bias, maybe(number()), "Cascade: it at the operating point.", {.unit = "y"})
        .field("d0", &Asked::d0, maybe(number()), "Feedforward: the disturbance at the operating point.")
        .field("compensator", &Asked::compensator,
               maybe(choice<std::string>({{"static", "static"},
                                          {"inverse", "inverse"},
                                          {"guzman_hagglund", "guzman_hagglund"},
                                          {"optimum", "optimum"},
                                          {"given", "given"}})),
               "Feedforward: which of the answer's; default: the chosen one.");
}

}  // namespace

Codec<code::Language> code_language() {
    return choice<Language>({{"st", Language::structured_text},
                             {"c", Language::c},
                             {"python", Language::python},
                             {"arduino", Language::arduino}});
}

const Description<CodeQuestion>& code_contract() {
    static const auto description = [] {
        Description<CodeQuestion> d("CodeQuestion", "Options of a controller's code.");
        d.field("language", &CodeQuestion::language, code_language(), "st, c, python or arduino.", {.required = true});
        add_rules(d);
        d.check(check_question);
        return d;
    }();
    return description;
}

const Description<SampledWish>& sampled_wish_contract() {
    static const auto description = [] {
        Description<SampledWish> d("StructureSampled",
                                   "The program of the controllers, call by call, with its limits.");
        add_rules(d);
        d.field("steps", &SampledWish::steps, sizes(), "Such as {\"setpoint\": 5}; 1 for the others.")
            .check([](const Json& value, SampledWish& wish, Reader& reader) { check_question(value, wish, reader); });
        return d;
    }();
    return description;
}

void refuse_others(const CodeQuestion& question, std::string_view structure, Reader& reader) {
    const auto refuse = [&](const char* name, bool given, std::string_view of) {
        if (given && structure != of)
            reader.fault_at(name,
                            std::string(name) + " belongs to the code of a " + std::string(of) + ". Leave it out.");
    };
    refuse("r2_min", question.r2_min.has_value(), "cascade");
    refuse("r2_max", question.r2_max.has_value(), "cascade");
    refuse("r2_bias", question.r2_bias.has_value(), "cascade");
    refuse("d0", question.d0.has_value(), "feedforward");
    refuse("compensator", question.compensator.has_value(), "feedforward");
}

}  // namespace tunewright::api
