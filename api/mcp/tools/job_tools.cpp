// Jobs of earlier calls.
#include "api/describe/body.h"
#include "api/mcp/job_tool.h"
#include "api/mcp/short_answer.h"
#include "api/mcp/tools.h"
#include "api/mcp/tools/arguments.h"

namespace tunewright::api::mcp {
namespace {

ToolOutcome job_status(const Json& arguments, ToolHost& host) {
    const auto read = decode(arguments, job_question_contract());
    if (const auto* problem = std::get_if<Problem>(&read)) return refused(*problem);
    const auto& question = std::get<JobQuestion>(read);
    if (!question.job) {
        auto list = host.newest();
        if (auto* refusal = std::get_if<Refused>(&list)) return std::move(*refusal);
        return short_jobs(std::get<std::string>(list));
    }
    auto found = host.find(*question.job, true);
    if (auto* refusal = std::get_if<Refused>(&found)) return std::move(*refusal);
    return job_outcome(std::get<ToolJob>(found), host);
}

}  // namespace

Tool job_status_tool() {
    return {.name = "job_status",
            .title = "State and answer of a job",
            .description =
                "The short answer of an earlier job, or its progress if it still runs (waits some seconds "
                "for its end); without an id, the newest jobs.",
            .example = R"json({"job": "1"})json",
            .makes_job = false,
            .arguments =
                [](ShownTypes& shown) {
                    return tool_schema([](SchemaBook& book) { return job_question_contract().schema(book); }, shown);
                },
            .call = job_status};
}

}  // namespace tunewright::api::mcp
