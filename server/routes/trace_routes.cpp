#include "api/csv/traces.h"

#include "server/http/app/negotiation.h"
#include "server/http/app/problems.h"
#include "server/routes/job_access.h"
#include "server/routes/routes.h"

namespace tunewright::server {
namespace {

using http::Call;
using http::problem_response;
using http::Response;

std::optional<Response> read_traces(const http::Request& request, api::Traces& traces) {
    for (const auto& [name, value] : request.query) {
        if (name == "traces" && value == "responses") {
            traces = api::Traces::responses;
        } else if (name == "traces" && value == "frequency") {
            traces = api::Traces::frequency;
        } else if (name == "traces" && value == "model") {
            traces = api::Traces::model;
        } else {
            api::Problem problem = http::problem(422, "The parameters of the call are not valid.");
            problem.errors.push_back(
                {"/" + name, name + " is \"" + value.substr(0, 64) +
                                 "\"; the only parameter is traces, which must be responses, frequency or model."});
            return http::problem_response(problem);
        }
    }
    return std::nullopt;
}

Response traces_of(const JobRecord& job, api::Traces traces) {
    if (!has_ended(job.status))
        return problem_response(409, "The job has not ended; its traces are available when it has succeeded.");
    if (job.result.empty())
        return problem_response(
            404, "The job " + job.id + " has ended as " + std::string(to_string(job.status)) + ", without a result.");
    auto text = api::traces_csv(job.result, traces);
    if (!text)
        return problem_response(404, traces == api::Traces::model
                                         ? "The result has no model with a record: the request gave a plant, or did "
                                           "not ask for it (identify.traces true)."
                                         : "The result has no traces: the request asked for none (evaluate.points 0, "
                                           "which is the default in a batch), or no entry has any.");
    Response response;
    response.body = *std::move(text);
    response.set("Content-Type", "text/csv; charset=utf-8; header=present");
    return response.set("Content-Disposition", "attachment; filename=\"job-" + job.id + ".csv\"");
}

Response get_traces(JobService& jobs, ComputeSlots& readers, const Call& call) {
    if (!http::accepts(call.request, "text/csv"))
        return problem_response(406, "The answer is text/csv, which the Accept field does not allow.");
    api::Traces traces = api::Traces::responses;
    if (auto refusal = read_traces(call.request, traces)) return *std::move(refusal);
    const std::string& id = call.path.at("id");
    return in_turn(readers, call.request, [&] {
        const std::optional<JobView> view = jobs.find(id);
        if (!view || !may_see(call.request, view->job)) return no_such_job(id);
        return traces_of(view->job, traces);
    });
}

}  // namespace

void add_trace_routes(http::Router& router, JobService& jobs, ComputeSlots& readers) {
    router.add("GET", "/v1/jobs/{id}/result.csv", [&](const Call& call) { return get_traces(jobs, readers, call); });
}

}  // namespace tunewright::server
