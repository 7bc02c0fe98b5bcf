#include "api/code/parameters.h"

#include <algorithm>
#include <limits>

#include "api/contract/device/device.h"
#include "api/contract/structure/structure_name.h"
#include "api/csv/text.h"
#include "engine/code/settings.h"
#include "engine/number_text.h"

namespace tunewright::api {

Controller read_controller(const Json& json, Reader& reader) {
    Controller controller;
    controller_contract().read(json, controller, reader);
    if (const auto* npid = std::get_if<Npid>(&controller); npid != nullptr && !npid->delta_r)
        reader.fault_at("delta_r",
                        "delta_r is missing; the nonlinear form needs the size of error for which it was designed.");
    return controller;
}

namespace {

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
