#include "api/mcp/job_tool.h"
#include "api/mcp/message.h"

#include <utility>

#include "api/contract/structure/structure_name.h"
#include "api/contract/terms.h"
#include "api/describe/reader.h"
#include "api/mcp/short_answer.h"
#include "api/report/check_words.h"

namespace tunewright::api::mcp {
namespace {

std::optional<Problem> refuse_terms(const Json& request) {
    Json computed = request;
    leave_out_terms(computed);
    Reader reader;
    for (const auto& [name, value] : request.items())
        if (!computed.contains(name))
            reader.fault_at(name, name +
                                      " is not possible in a tool: it is a term of a job that is posted with POST "
                                      "/v1/jobs. Leave it out.");
    return reader.problem();
}

/// The screen of the page that shows the result.
std::string screen_of(const std::string& result) {
    const Json value = Json::parse(result, nullptr, false);
    if (is_of_check(value)) return "check";
    if (!structure_of(value).empty()) return "structure";
    return value.contains("range") ? "range" : "design";
}

ToolAnswer state_of(const ToolJob& job) {
    const Json progress = Json::parse(job.progress, nullptr, false);
    Json figures{{"job", job.id}, {"status", job.status}};
    std::string text = "The job " + job.id + " is " + job.status;
    if (progress.is_object()) {
        figures["fraction"] = progress.value("fraction", Json());
        text += ": " + progress.value("message", "");
    }
    return {text + "\nCall job_status with {\"job\": \"" + job.id + "\"} for its answer.\n", std::move(figures)};
}

}  // namespace

void add_addresses(ToolAnswer& answer, const std::string& id, const std::string& screen, const ToolHost& host) {
    if (id.empty()) return;
    Json whole{{"resource", kAnswerResource + id}};
    std::string text = "Job " + id + ". Whole answer: resource " + kAnswerResource + id;
    for (const auto& [word, address] : host.addresses(id, screen)) {
        whole[word] = address;
        text += ", " + word + " " + address;
    }
    answer.text += text + "\n";
    if (answer.figures.is_null()) return;
    answer.figures["job"] = id;
    answer.figures["whole"] = std::move(whole);
}

ToolOutcome job_outcome(const ToolJob& job, const ToolHost& host) {
    if (!job.result.empty()) {
        ToolAnswer answer = short_result(job.result);
        if (job.status != "succeeded")
            answer.text = "The job was stopped; this is the best until then.\n" + answer.text;
        add_addresses(answer, job.id, screen_of(job.result), host);
        return answer;
    }
    if (!job.error.empty()) return Refused{job.error};
    return state_of(job);
}

ToolOutcome run_as_job(Json request, ToolHost& host) {
    if (const auto problem = refuse_terms(request)) return refused(*problem);
    auto prepared = prepare_entry(json_text(request), host.limits());
    if (const auto* problem = std::get_if<Problem>(&prepared)) return refused(*problem);
    request = nullptr;
    auto ran = host.run(std::get<PreparedJob>(std::move(prepared)));
    if (auto* refusal = std::get_if<Refused>(&ran)) return std::move(*refusal);
    return job_outcome(std::get<ToolJob>(ran), host);
}

ToolOutcome computed(const Computation& work, ToolAnswer (*shorten)(std::string_view), ToolHost& host) {
    const auto [answer, id] = host.compute(work);
    if (answer.status >= 400) return Refused{answer.body};
    ToolAnswer made = shorten(answer.body);
    add_addresses(made, id, "", host);
    return made;
}

}  // namespace tunewright::api::mcp
