#include "api/code/parts.h"
#include "api/contract/range/range_request.h"
#include "engine/code/algorithm.h"

namespace tunewright::api {
namespace {

/// With its times in seconds, as programs count.
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

}  // namespace

std::variant<ControllerCode, Problem> written_schedule(const ChosenEntry& found, const CodeWords& words) {
    Reader reader;
    const AskedCode asked = read_asked(words, found, reader);
    const Json& answer = found.result.at("range");
    const Schedule schedule = schedule_of(answer.at("schedule"), asked.unit, reader);
    if (auto problem = reader.problem()) return *std::move(problem);
    SampledPid law = law_of(asked, {});
    law.gains = to_parallel(controller_of(code::leading_row(schedule)));  // which are in seconds already
    const auto sample_time = sample_time_of(asked, found.request, law.gains, answer.at("schedule"));
    if (const auto* problem = std::get_if<Problem>(&sample_time)) return *problem;
    law.Ts = std::get<SampleTime>(sample_time).seconds;
    const auto program =
        code::scheduled_algorithm(schedule, law, options_of(asked, found.result), named(answer.at("scheduling")));
    if (!program) return to_problem(program.error());
    return printed(*program, asked.question.language, provenance_of_schedule(found.result, found.request),
                   std::get<SampleTime>(sample_time));
}

}  // namespace tunewright::api
