// Controllers, and tests that a controller runs by itself, as programs.
#include "api/code/code.h"
#include "api/code/experiment_code.h"
#include "api/contract/device/code_question.h"
#include "api/contract/device/experiment_question.h"
#include "api/describe/body.h"
#include "api/describe/suggest.h"
#include "api/mcp/tools.h"
#include "api/mcp/tools/arguments.h"

namespace tunewright::api::mcp {
namespace {

Json code_arguments(ShownTypes& shown) {
    Json schema = both(tool_schema([](SchemaBook& book) { return program_subject_contract().schema(book); }, shown),
                       tool_schema([](SchemaBook& book) { return code_contract().schema(book); }, shown));
    schema["required"] = {"language"};
    return schema;
}

/// The arguments in two parts: the subject, and the parameters as typed. A name that is neither, but near to one of the
/// subject's, stays with the subject, which suggests it.
struct Parts {
    Json subject = Json::object();
    CodeWords words;
};
Parts parts_of(const Json& arguments) {
    const std::vector<std::string> names{"job", "index", "controller", "units"};
    Parts parts;
    for (const auto& [name, value] : arguments.items()) {
        if (!code_contract().has(name) && !nearest(name, names).empty())
            parts.subject[name] = value;
        else
            parts.words.emplace_back(name, value.is_string() ? value.get<std::string>() : value.dump());
    }
    return parts;
}

/// A result with that controller alone.
std::string result_of(const Json& subject) {
    Json result{{"controllers", {{{"controller", subject.at("controller")}}}}};
    if (subject.contains("units")) result["units"] = subject["units"];
    return result.dump();
}

Problem no_subject(const char* sentence) {
    Reader reader;
    reader.fault_at("job", sentence);
    return *reader.problem();
}

ToolOutcome written(const ResultSource& source, const std::string& index, const CodeWords& words) {
    auto code = controller_code(source, index, words);
    if (const auto* problem = std::get_if<Problem>(&code)) return refused(*problem);
    return ToolAnswer{std::move(std::get<ControllerCode>(code).text), nullptr};
}

ToolOutcome code_of_job(const ProgramSubject& subject, const CodeWords& words, ToolHost& host) {
    auto found = host.find(*subject.job, false);
    if (auto* refusal = std::get_if<Refused>(&found)) return std::move(*refusal);
    const auto& job = std::get<ToolJob>(found);
    if (job.result.empty()) return refused(no_subject("The job has no result; job_status says in which state it is."));
    return written({job.result, job.request}, subject.index ? std::to_string(*subject.index) : "", words);
}

ToolOutcome code(const Json& arguments, ToolHost& host) {
    const Parts parts = parts_of(arguments);
    const auto read = decode(parts.subject, program_subject_contract());
    if (const auto* problem = std::get_if<Problem>(&read)) return refused(*problem);
    const auto& subject = std::get<ProgramSubject>(read);
    if (subject.job.has_value() == subject.controller.has_value())
        return refused(no_subject(subject.job ? "job and controller are both given. Leave one out."
                                              : "job is missing; give the id of a job, or a controller."));
    return subject.job ? code_of_job(subject, parts.words, host) : written({result_of(parts.subject)}, "", parts.words);
}

Json test_arguments(ShownTypes& shown) {
    return tool_schema([](SchemaBook& book) { return experiment_contract().schema(book); }, shown);
}

ToolOutcome test_program(const Json& arguments, ToolHost&) {
    auto code = experiment_code(arguments.dump());
    if (const auto* problem = std::get_if<Problem>(&code)) return refused(*problem);
    return ToolAnswer{std::move(std::get<ControllerCode>(code).text), nullptr};
}

}  // namespace

Tool code_tool() {
    return {.name = "code",
            .title = "Controller as a program",
            .description =
                "The controller of a job, or a given one, as source text: Structured Text (st), C, Python or a sketch "
                "for an "
                "Arduino, with limits, anti-windup, bumpless manual/automatic. Use it when the controller is not a "
                "product's block. "
                "sample_time in units.time; u_min and u_max are the ends of the actuator.",
            .example =
                R"json({"controller": {"form": "ideal", "Kp": 0.84, "Ti": 5.7, "Td": 1.3}, "language": "st", )json"
                R"json("sample_time": 0.5, "u_min": 0, "u_max": 100})json",
            .makes_job = false,
            .arguments = code_arguments,
            .call = code};
}

Tool test_program_tool() {
    return {
        .name = "test_program",
        .title = "A test that a controller runs by itself",
        .description =
            "A relay test, or a step and back (bump), as source text for the plant's own controller. It measures the "
            "noise, stays within limits of u, y, rate and time, ends by itself, has a safe u for every fault, and "
            "writes rows t, u, y for identify. Use it when there is no record yet. Times in s. It is text: nothing "
            "is run.",
        .example = R"json({"experiment": "relay", "language": "st", "sample_time": 0.5, "u_step": 5, )json"
                   R"json("u_min": 0, "u_max": 100, "y_min": 20, "y_max": 80})json",
        .makes_job = false,
        .arguments = test_arguments,
        .call = test_program};
}

}  // namespace tunewright::api::mcp
