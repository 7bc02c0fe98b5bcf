#include "api/code/code.h"

#include "api/code/parts.h"
#include "api/contract/controller.h"

namespace tunewright::api {
namespace {

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

Problem no_schedule() {
    return {404,
            "not-found",
            "Not Found",
            "This is no answer about an operating range with a schedule. Give what `range` or a succeeded job about a "
            "range has answered.",
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
        if (auto problem = find_entry(index, found)) return *std::move(problem);
        return written_entry(found, words);
    } catch (const Json::exception&) {  // a file that only looks like a result: its members are of other kinds
        return not_a_result();
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
