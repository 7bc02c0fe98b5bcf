#include "api/code/parameters.h"

#include <algorithm>
#include <limits>
#include <utility>

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

bool is_named(const CodeWords& words, std::string_view name) {
    return std::ranges::any_of(words, [&](const auto& word) { return word.first == name; });
}

/// The request of a structure has its program simulated.
bool is_simulated(const ChosenEntry& found) {
    return !structure_of(found.result).empty() && found.request.is_object() &&
           found.request.value("sampled", Json()).is_object();
}

/// The members of `sampled`, so that the program is the one that was simulated, without those that a parameter of the
/// call replaces.
Json simulated_rules(const CodeWords& words, const Json& request) {
    Json out = Json::object();
    // A rule takes its own setting with it.
    constexpr std::pair<const char*, const char*> kReplaced[] = {
        {"derivative", "slope_samples"}, {"anti_windup", "tracking_time"}, {"tracking_time", "anti_windup"}};
    const auto replaced = [&](const std::string& name) {
        return is_named(words, name) || std::ranges::any_of(kReplaced, [&](const auto& pair) {
                   return name == pair.second && is_named(words, pair.first);
               });
    };
    for (const auto& [name, value] : request.at("sampled").items())
        if (name != "steps" && name != "sample_time" && !value.is_null() && !replaced(name)) out[name] = value;
    return out;
}

/// `defaults`: for what the words do not name.
void read_words(const CodeWords& words, const Json& defaults, CodeQuestion& question, Reader& reader) {
    Json given = json_of(words, reader);
    for (const auto& [name, value] : defaults.items())
        if (!given.contains(name)) given[name] = value;
    code_contract().read(given, question, reader);
}

/// Takes the rules with which the request evaluated the program, for those that the parameters do not name.
void take_implemented(const CodeWords& words, const Json& request, CodeQuestion& question) {
    if (!request.is_object() || !request.contains("implement") || !request.at("implement").is_object()) return;
    GivenDevice given;
    Reader reader;  // a request that was answered has no faults
    implement_contract().read(request.at("implement"), given, reader);
    const auto asked = [&](const char* name) { return is_named(words, name); };
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

Json json_of(const CodeWords& words, Reader& reader) {
    Json given = Json::object();
    for (const auto& [name, word] : words) {
        std::string name_storage, word_storage;
        const std::string key(utf8_text(name, name_storage)), value(utf8_text(word, word_storage));
        if (given.contains(key)) reader.fault_at(key, key + " is given twice. Leave one out.");
        Json number = Json::parse(value, nullptr, false);
        given[key] = number.is_number() ? std::move(number) : Json(value);
    }
    return given;
}

AskedCode read_asked(const CodeWords& words, const ChosenEntry& found, Reader& reader) {
    AskedCode asked;
    const bool simulated = is_simulated(found);
    read_words(words, simulated ? simulated_rules(words, found.request) : Json::object(), asked.question, reader);
    if (!simulated) take_implemented(words, found.request, asked.question);
    refuse_others(asked.question, structure_of(found.result), reader);
    asked.unit = unit_of(found.result, reader);
    return asked;
}

std::variant<SampleTime, Problem> sample_time_of(const AskedCode& asked, const Json& request, const ParallelPid& gains,
                                                 const Json& design, double shortest_lag) {
    const auto given = design.find("longest_sample_time");
    std::optional<double> longest;
    if (given != design.end() && given->is_number()) longest = given->get<double>() * asked.unit;
    const auto chosen = [&](double seconds, std::string origin) {
        if (longest && seconds > *longest)
            origin += "; beyond " + tunewright::text(*longest, 3) + " s it raises Ms by more than 5 %";
        return SampleTime{seconds, std::move(origin)};
    };
    if (asked.question.sample_time) return chosen(*asked.question.sample_time * asked.unit, "as asked for");
    for (const char* place : {"/sampled/sample_time", "/implement/sample_time", "/implement/0/sample_time"})
        if (const double requested = number_at(request, place); requested > 0)
            return chosen(requested * asked.unit, "from the request");
    constexpr double kNoLimit = std::numeric_limits<double>::infinity();
    const auto of_controller = code::proposed_sample_time(gains);
    if (const auto proposed = code::proposed_sample_time(gains, shortest_lag / 10);
        proposed && shortest_lag < kNoLimit && proposed != of_controller)
        return SampleTime{*proposed,
                          "proposed, because none was given: a tenth of the shortest lag of the compensator or of the "
                          "predictor's filter, rounded down"};
    if (const auto proposed = code::proposed_sample_time(gains, longest.value_or(kNoLimit)))
        return SampleTime{*proposed, proposed == of_controller
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
