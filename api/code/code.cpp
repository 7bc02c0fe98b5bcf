#include "api/code/code.h"

#include "api/code/parameters.h"
#include "api/code/provenance.h"
#include "api/code/structure_program.h"
#include "api/contract/controller.h"
#include "api/contract/range/range_request.h"
#include "api/contract/structure/structure_name.h"
#include "engine/code/algorithm.h"
#include "engine/number_text.h"

namespace tunewright::api {
namespace {

Controller controller_of(const Json& entry, Reader& reader) {
    const Reader::At at(reader, "controller");
    return read_controller(entry.at("controller"), reader);
}

std::variant<ControllerCode, Problem> written(const ChosenEntry& found, const AskedCode& asked,
                                              const Controller& controller) {
    SampledPid law = law_of(asked, gains(controller));
    const auto sample_time = sample_time_of(asked, found.request, law.gains, found.entry());
    if (const auto* problem = std::get_if<Problem>(&sample_time)) return *problem;
    law.Ts = std::get<SampleTime>(sample_time).seconds;
    code::CodeOptions options = options_of(asked, found.result);
    if (const auto* npid = std::get_if<Npid>(&controller)) options.delta_r = npid->delta_r;
    const auto program = code::pid_algorithm(law, options);
    if (!program) return to_problem(program.error());
    return printed(*program, asked.question.language, provenance_of(found.result, found.entry(), found.request),
                   std::get<SampleTime>(sample_time));
}

std::variant<ControllerCode, Problem> written_entry(const ChosenEntry& found, const CodeWords& words) {
    Reader reader;
    const AskedCode asked = read_asked(words, found, reader);
    const Controller controller = controller_of(found.entry(), reader);
    if (auto problem = reader.problem()) return *std::move(problem);
    return written(found, asked, controller);
}

/// The schedule with its times in seconds, the unit of programs.
Schedule schedule_of(const Json& schedule, double unit, Reader& reader) {
    Schedule read;
    read.hysteresis = schedule.value("hysteresis", 0.0);
    const Reader::At at(reader, "interpolation");
    interpolation_word().read(schedule.at("interpolation"), read.interpolation, reader);
    for (const Json& row : schedule.at("rows"))
        read.rows.push_back({.at = row.at("at").get<double>(),
                             .Kp = row.at("Kp").get<double>(),
                             .Ti = row.at("Ti").get<double>() * unit,
                             .Td = row.value("Td", 0.0) * unit,
                             .Tf = row.value("Tf", 0.0) * unit,
                             .b = row.value("b", 1.0)});
    return read;
}

/// "level in cm".
std::string named(const Json& scheduling) {
    const std::string unit = scheduling.value("unit", "");
    return scheduling.value("name", "") + (unit.empty() ? "" : " in " + unit);
}

/// The program of the schedule in an answer about a range. May throw Json::exception, like choose_entry.
std::variant<ControllerCode, Problem> written_schedule(const ChosenEntry& found, const CodeWords& words) {
    Reader reader;
    const AskedCode asked = read_asked(words, found, reader);
    const Json& answer = found.result.at("range");
    const Schedule schedule = schedule_of(answer.at("schedule"), asked.unit, reader);
    if (auto problem = reader.problem()) return *std::move(problem);
    SampledPid law = law_of(asked, {});
    law.gains = to_parallel(controller_of(code::leading_row(schedule)));  // its times are in seconds already
    const auto sample_time = sample_time_of(asked, found.request, law.gains, answer.at("schedule"));
    if (const auto* problem = std::get_if<Problem>(&sample_time)) return *problem;
    law.Ts = std::get<SampleTime>(sample_time).seconds;
    const auto program =
        code::scheduled_algorithm(schedule, law, options_of(asked, found.result), named(answer.at("scheduling")));
    if (!program) return to_problem(program.error());
    return printed(*program, asked.question.language, provenance_of_schedule(found.result, found.request),
                   std::get<SampleTime>(sample_time));
}

Problem no_schedule() {
    return {404,
            "not-found",
            "Not Found",
            "This is not an answer about an operating range with a schedule. Give the answer of `range` or of a "
            "succeeded job about a range.",
            {},
            {}};
}

}  // namespace

std::variant<ControllerCode, Problem> controller_code(const ResultSource& source, const std::string& index,
                                                      const CodeWords& words) {
    try {
        ChosenEntry found;
        if (auto problem = read_result(source, found)) return *std::move(problem);
        if (index.empty() && has_schedule(found.result)) return written_schedule(found, words);
        if (index.empty() && !structure_of(found.result).empty()) return written_structure(found, words);
        if (auto problem = find_entry(index, found)) return *std::move(problem);
        return written_entry(found, words);
    } catch (const Json::exception&) {  // a file that only resembles a result: its members have other types
        return not_a_result();
    }
}

std::variant<ControllerCode, Problem> structure_code(const ResultSource& source, const CodeWords& words) {
    Problem none{404, "not-found", "Not Found", "", {}, {}};
    none.detail = "This is not an answer about a structure. The code of a controller has its number in the address.";
    try {
        ChosenEntry found;
        if (auto problem = read_result(source, found)) return *std::move(problem);
        if (structure_of(found.result).empty()) return none;
        return written_structure(found, words);
    } catch (const Json::exception&) {
        return none;
    }
}

std::variant<ControllerCode, Problem> schedule_code(const ResultSource& source, const CodeWords& words) {
    try {
        ChosenEntry found;
        if (auto problem = read_result(source, found)) return *std::move(problem);
        if (!has_schedule(found.result)) return no_schedule();
        return written_schedule(found, words);
    } catch (const Json::exception&) {
        return no_schedule();
    }
}

}  // namespace tunewright::api
