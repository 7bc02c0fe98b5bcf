#include "api/code/code.h"

#include <algorithm>
#include <charconv>

#include "api/code/parts.h"
#include "api/contract/controller.h"
#include "api/csv/text.h"
#include "engine/code/settings.h"
#include "engine/number_text.h"

namespace tunewright::api {
namespace {

/// Words that spell numbers become numbers; what the contract does not take stays as it was typed, for its sentence.
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

/// Seconds in the result's unit of time.
double unit_of(const Json& result, Reader& reader) {
    const Json::json_pointer place("/units/time");
    const std::string label =
        result.contains(place) && result.at(place).is_string() ? result.at(place).get<std::string>() : "s";
    if (const auto seconds = code::seconds_in(label)) return *seconds;
    const Reader::At units(reader, "units");
    reader.fault_at("time", "units.time is " + shown(Json(label)) +
                                "; code counts seconds and knows s, ms, min, h and d. Tune in one of these.");
    return 1;
}

struct SampleTime {
    double seconds = 0;
    std::string origin;
};

/// As asked for, else as the request says how the controller runs, else from the controller's own times.
std::optional<SampleTime> sample_time_of(const CodeQuestion& question, const Json& request, const ParallelPid& gains,
                                         double unit) {
    if (question.sample_time) return SampleTime{*question.sample_time * unit, "as asked for"};
    const Json::json_pointer place("/implement/sample_time");
    if (request.is_object() && request.contains(place) && request.at(place).is_number() &&
        request.at(place).get<double>() > 0)
        return SampleTime{request.at(place).get<double>() * unit, "as the request says"};
    if (const auto proposed = code::proposed_sample_time(gains))
        return SampleTime{*proposed,
                          "proposed, as none was asked for: a tenth of the shorter of Ti and Td, no more than Tf, "
                          "rounded down"};
    return std::nullopt;
}

double number_at(const Json& value, const char* place) {
    const Json::json_pointer pointer(place);
    return value.contains(pointer) && value.at(pointer).is_number() ? value.at(pointer).get<double>() : 0;
}

code::CodeOptions options_of(const CodeQuestion& question, const Controller& controller, const Json& result,
                             double unit) {
    code::CodeOptions options;
    options.anti_windup = question.anti_windup.value_or(code::AntiWindup::back_calculation);
    options.u_min = question.u_min;
    options.u_max = question.u_max;
    options.rate_limit = question.rate_limit.value_or(0) / unit;
    if (question.tracking_time) options.tracking_time = *question.tracking_time * unit;
    options.bias = question.bias.value_or(number_at(result, "/operating_point/u"));
    options.y0 = question.y0.value_or(number_at(result, "/operating_point/y"));
    if (const auto* npid = std::get_if<Npid>(&controller)) options.delta_r = npid->delta_r;
    return options;
}

ControllerCode file_of(code::Language language, std::string text) {
    switch (language) {
        case code::Language::structured_text: return {"text/plain", "TunewrightPid.st", std::move(text)};
        case code::Language::c: return {"text/x-c", "tunewright_pid.h", std::move(text)};
        case code::Language::python: return {"text/x-python", "tunewright_pid.py", std::move(text)};
    }
    return {};
}

/// The controller of the entry; a nonlinear one says for which errors it was made.
Controller controller_of(const Json& entry, Reader& reader) {
    const Reader::At at(reader, "controller");
    Controller controller;
    controller_contract().read(entry.at("controller"), controller, reader);
    if (const auto* npid = std::get_if<Npid>(&controller); npid != nullptr && !npid->delta_r)
        reader.fault_at("delta_r",
                        "delta_r is missing; the nonlinear form needs the size of error that it was made for.");
    return controller;
}

std::variant<ControllerCode, Problem> written(const ChosenEntry& found, const CodeQuestion& question,
                                              const Controller& controller, double unit) {
    SampledPid law{.gains = gains(controller),
                   .integral = question.integral,
                   .derivative = question.derivative,
                   .slope_samples = question.slope_samples.value_or(1),
                   .velocity = question.velocity};
    law = code::in_seconds(law, unit);
    const auto sample_time = sample_time_of(question, found.request, law.gains, unit);
    if (!sample_time) {
        Reader reader;
        reader.fault_at("sample_time",
                        "sample_time is missing; this controller has no time of its own to propose one from.");
        return *reader.problem();
    }
    law.Ts = sample_time->seconds;
    const auto program = code::pid_algorithm(law, options_of(question, controller, found.result, unit));
    if (!program) return to_problem(program.error());
    code::Provenance rows = provenance_of(found.result, found.entry(), found.request);
    rows.emplace_back("Sample time", tunewright::text(law.Ts, 6) + " s, " + sample_time->origin);
    return file_of(question.language, code::print(*program, question.language, rows));
}

}  // namespace

std::variant<ControllerCode, Problem> controller_code(const ResultSource& source, const std::string& index,
                                                      const CodeWords& words) {
    try {
        auto chosen = choose_entry(source, index);
        if (auto* problem = std::get_if<Problem>(&chosen)) return std::move(*problem);
        const auto& found = std::get<ChosenEntry>(chosen);
        Reader reader;
        CodeQuestion question;
        read_words(words, question, reader);
        const double unit = unit_of(found.result, reader);
        const Controller controller = controller_of(found.entry(), reader);
        if (auto problem = reader.problem()) return *std::move(problem);
        return written(found, question, controller, unit);
    } catch (const Json::exception&) {  // a file that only looks like a result: its members are of other kinds
        return not_a_result();
    }
}

}  // namespace tunewright::api
