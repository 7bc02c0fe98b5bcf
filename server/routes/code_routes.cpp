#include <functional>
#include <variant>

#include "api/code/code.h"
#include "api/code/experiment_code.h"
#include "server/http/app/negotiation.h"
#include "server/http/app/problems.h"
#include "server/routes/job_access.h"
#include "server/routes/request_checks.h"
#include "server/routes/routes.h"

namespace tunewright::server {
namespace {

using http::Call;
using http::problem_response;
using http::Response;

using Written = std::variant<api::ControllerCode, api::Problem>;

api::CodeWords words_of(const Call& call) { return {call.request.query.begin(), call.request.query.end()}; }

Response file_of(const Written& written, const Call& call) {
    if (const auto* problem = std::get_if<api::Problem>(&written)) return problem_response(*problem);
    const auto& code = std::get<api::ControllerCode>(written);
    if (!http::accepts(call.request, code.media_type))
        return problem_response(406, "The answer is " + code.media_type + ", which the Accept field does not allow.");
    Response response;
    response.body = code.text;
    response.set("Content-Type", code.media_type + "; charset=utf-8");
    return response.set("Content-Disposition", "attachment; filename=\"" + code.file_name + "\"");
}

Response code_of(const JobRecord& job, const Call& call, const std::function<Written(const JobRecord&)>& write) {
    if (!has_ended(job.status))
        return problem_response(
            409, "The job has not ended; the code of its controllers is available when it has succeeded.");
    if (job.result.empty())
        return problem_response(
            404, "The job " + job.id + " has ended as " + std::string(to_string(job.status)) + ", without a result.");
    return file_of(write(job), call);
}

Response get_code(JobService& jobs, ComputeSlots& readers, const Call& call,
                  const std::function<Written(const JobRecord&)>& write) {
    const std::string& id = call.path.at("id");
    return in_turn(readers, call.request, [&] {
        const std::optional<JobView> view = jobs.find(id);
        if (!view || !may_see(call.request, view->job)) return no_such_job(id);
        return code_of(view->job, call, write);
    });
}

}  // namespace

void add_code_routes(http::Router& router, JobService& jobs, ComputeSlots& readers) {
    router.add("GET", "/v1/jobs/{id}/controllers/{index}/code", [&](const Call& call) {
        return get_code(jobs, readers, call, [&](const JobRecord& job) {
            return api::controller_code({job.result, job.request}, call.path.at("index"), words_of(call));
        });
    });
    router.add("GET", "/v1/jobs/{id}/code", [&](const Call& call) {
        return get_code(jobs, readers, call, [&](const JobRecord& job) {
            return api::structure_code({job.result, job.request}, words_of(call));
        });
    });
    router.add("POST", "/v1/experiments/code", [](const Call& call) {
        if (auto refusal = refuse_body(call.request)) return *std::move(refusal);
        return file_of(api::experiment_code(call.request.body), call);
    });
    router.add("GET", "/v1/jobs/{id}/schedule/code", [&](const Call& call) {
        return get_code(jobs, readers, call, [&](const JobRecord& job) {
            return api::schedule_code({job.result, job.request}, words_of(call));
        });
    });
}

}  // namespace tunewright::server
