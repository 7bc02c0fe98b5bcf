#include "api/code/parameters.h"

#include <algorithm>
#include <limits>

#include "api/contract/device/device.h"
#include "api/contract/structure/structure_name.h"
#include "api/csv/text.h"
#include "engine/code/settings.h"
#include "engine/number_text.h"

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
    if (question.u_min && question.u_max && !(*question.u_min < *question.u_max))
        reader.fault_at("u_max", "u_max is " + shown(value.at("u_max")) + " and u_min " + shown(value.at("u_min")) +
                                     "; u_max must be > u_min.");
}

}  // namespace

const Description<CodeQuestion>& code_contract() {
    static const auto description = [] {
        using Q = CodeQuestion;
        Description<Q> d("CodeQuestion", "Options of a controller's code.");
        d.field("language", &Q::language,
                choice<Language>({{"st", Language::structured_text}, {"c", Language::c}, {"python", Language::python}}),
                "st, c or python.", {.required = true})
            .field("sample_time", &Q::sample_time, maybe(number({.exclusive_minimum = 0})),
                   "Time from one call to the next.", {.unit = "time"})
            .field("integral", &Q::integral, integral_rule(), "Rule of the integral.")
            .field("derivative", &Q::derivative, derivative_rule(), "Rule of the derivative.")
            .field("slope_samples", &Q::slope_samples, maybe(integer(1, code::kMaxSlopeSamples)),
                   "Number of sample times that the rule slope spans.")
            .field("form", &Q::velocity, choice<bool>({{"position", false}, {"velocity", true}}),
                   "position: u is a sum; velocity: the last u plus its increment.")
            .field("anti_windup", &Q::anti_windup,
                   maybe(choice<AntiWindup>(
                       {{"back_calculation", AntiWindup::back_calculation}, {"clamping", AntiWindup::clamping}})),
                   "Behaviour of the integral at a limit.")
            .field("tracking_time", &Q::tracking_time, maybe(number({.exclusive_minimum = 0})),
                   "Tracking time of back-calculation.", {.unit = "time"})
            .field("u_min", &Q::u_min, maybe(number()), "Least u.", {.unit = "u"})
            .field("u_max", &Q::u_max, maybe(number()), "Largest u.", {.unit = "u"})
            .field("rate_limit", &Q::rate_limit, maybe(number({.exclusive_minimum = 0})),
                   "Largest change of u per unit of time.", {.unit = "u/time"})
            .field("bias", &Q::bias, maybe(number()), "u at the operating point.", {.unit = "u"})
            .field("y0", &Q::y0, maybe(number()), "y at the operating point.", {.unit = "y"})
            .field("r2_min", &Q::r2_min, maybe(number()), "Cascade: least set point of the inner loop.", {.unit = "y"})
            .field("r2_max", &Q::r2_max, maybe(number()), "Cascade: its largest.", {.unit = "y"})
            .field("r2_bias", &Q::r2_bias, maybe(number()), "Cascade: it at the operating point.", {.unit = "y"})
            .field("d0", &Q::d0, maybe(number()), "Feedforward: the disturbance at the operating point.")
            .field("compensator", &Q::compensator,
                   maybe(choice<std::string>({{"static", "static"},
                                              {"inverse", "inverse"},
                                              {"guzman_hagglund", "guzman_hagglund"},
                                              {"optimum", "optimum"},
                                              {"given", "given"}})),
                   "Feedforward: which of the answer's; default: the last.")
            .check(check_question);
        return d;
    }();
    return description;
}

Controller read_controller(const Json& json, Reader& reader) {
    Controller controller;
    controller_contract().read(json, controller, reader);
    if (const auto* npid = std::get_if<Npid>(&controller); npid != nullptr && !npid->delta_r)
        reader.fault_at("delta_r",
                        "delta_r is missing; the nonlinear form needs the size of error for which it was designed.");
    return controller;
}

namespace {

/// The members that belong to one structure each; `structure` "": to none of them.
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

/// Texts that are numbers become numbers; a text that the contract refuses stays as typed, so that its error can quote
/// it.
void read_words(const CodeWords& words, CodeQuestion& question, Reader& reader) {
    Json given = Json::object();
    for (const auto& [name, word] : words) {
        std::string name_storage, word_storage;
        const std::string key(utf8_text(name, name_storage)), value(utf8_text(word, word_storage));
        if (given.contains(key)) reader.fault_at(key, key + " is given twice. Leave one out.");
        Json number = Json::parse(value, nullptr, false);
        given[key] = number.is_number() ? std::move(number) : Json(value);
    }
    code_contract().read(given, question, reader);
}

/// Takes the rules with which the request evaluated the program, for those that the parameters do not name.
void take_implemented(const CodeWords& words, const Json& request, CodeQuestion& question) {
    if (!request.is_object() || !request.contains("implement") || !request.at("implement").is_object()) return;
    GivenDevice given;
    Reader reader;  // a request that was answered has no faults
    implement_contract().read(request.at("implement"), given, reader);
    const auto asked = [&](const char* name) {
        return std::ranges::any_of(words, [&](const auto& word) { return word.first == name; });
    };
    if (given.integral && !asked("integral")) question.integral = *given.integral;
    if (given.derivative == GivenDevice::Derivative::difference && !asked("derivative"))
        question.derivative = DerivativeRule::difference;
    if (given.velocity && !asked("form") && !asked("anti_windup") && !asked("tracking_time"))
        question.velocity = *given.velocity;
}

/// Seconds in the result's unit of time.
double unit_of(const Json& result, Reader& reader) {
    const Json::json_pointer place("/units/time");
    const std::string label =
        result.contains(place) && result.at(place).is_string() ? result.at(place).get<std::string>() : "s";
    if (const auto seconds = code::seconds_in(label)) return *seconds;
    const Reader::At units(reader, "units");
    reader.fault_at("time", "units.time is " + shown(Json(label)) +
                                "; code counts in seconds and can convert s, ms, min, h and d. Tune in one of these.");
    return 1;
}

double number_at(const Json& value, const char* place) {
    const Json::json_pointer pointer(place);
    return value.contains(pointer) && value.at(pointer).is_number() ? value.at(pointer).get<double>() : 0;
}

}  // namespace

AskedCode read_asked(const CodeWords& words, const ChosenEntry& found, Reader& reader) {
    AskedCode asked;
    read_words(words, asked.question, reader);
    take_implemented(words, found.request, asked.question);
    refuse_others(asked.question, structure_of(found.result), reader);
    asked.unit = unit_of(found.result, reader);
    return asked;
}

std::variant<SampleTime, Problem> sample_time_of(const AskedCode& asked, const Json& request, const ParallelPid& gains,
                                                 const Json& design) {
    const auto given = design.find("longest_sample_time");
    std::optional<double> longest;
    if (given != design.end() && given->is_number()) longest = given->get<double>() * asked.unit;
    const auto chosen = [&](double seconds, std::string origin) {
        if (longest && seconds > *longest)
            origin += "; beyond " + tunewright::text(*longest, 3) + " s it raises Ms by more than 5 %";
        return SampleTime{seconds, std::move(origin)};
    };
    if (asked.question.sample_time) return chosen(*asked.question.sample_time * asked.unit, "as asked for");
    const Json::json_pointer place("/implement/sample_time");
    if (request.is_object() && request.contains(place) && request.at(place).is_number() &&
        request.at(place).get<double>() > 0)
        return chosen(request.at(place).get<double>() * asked.unit, "from the request");
    constexpr double kNoLimit = std::numeric_limits<double>::infinity();
    if (const auto proposed = code::proposed_sample_time(gains, longest.value_or(kNoLimit)))
        return SampleTime{*proposed, proposed == code::proposed_sample_time(gains)
                                         ? "proposed, because none was given: a tenth of the shorter of Ti and Td, no "
                                           "more than Tf, rounded down"
                                         : "proposed, because none was given: the longest that raises Ms by no more "
                                           "than 5 %, rounded down"};
    Reader reader;
    reader.fault_at("sample_time",
                    "sample_time is missing; this controller has no time from which one can be proposed.");
    return *reader.problem();
}

SampledPid law_of(const AskedCode& asked, const ParallelPid& gains) {
    const CodeQuestion& question = asked.question;
    return code::in_seconds({.gains = gains,
                             .integral = question.integral,
                             .derivative = question.derivative,
                             .slope_samples = question.slope_samples.value_or(1),
                             .velocity = question.velocity},
                            asked.unit);
}

code::CodeOptions options_of(const AskedCode& asked, const Json& result) {
    const CodeQuestion& question = asked.question;
    code::CodeOptions options;
    options.anti_windup = question.anti_windup.value_or(code::AntiWindup::back_calculation);
    options.u_min = question.u_min;
    options.u_max = question.u_max;
    options.rate_limit = question.rate_limit.value_or(0) / asked.unit;
    if (question.tracking_time) options.tracking_time = *question.tracking_time * asked.unit;
    options.bias = question.bias.value_or(number_at(result, "/operating_point/u"));
    options.y0 = question.y0.value_or(number_at(result, "/operating_point/y"));
    return options;
}

}  // namespace tunewright::api
