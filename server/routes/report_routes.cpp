#include <string>
#include <string_view>
#include <variant>

#include "api/report/report.h"
#include "server/http/app/negotiation.h"
#include "server/http/app/problems.h"
#include "server/json_text.h"
#include "server/routes/job_access.h"
#include "server/routes/request_checks.h"
#include "server/routes/routes.h"

namespace tunewright::server {
namespace {

using http::Call;
using http::problem_response;
using http::Response;

/// A page to print about one controller of a result.
struct PrintedPage {
    const char *path, *name;
    std::variant<std::string, api::Problem> (*write)(const api::ResultSource&, std::string_view,
                                                     const api::ReportWords&);
};

constexpr PrintedPage kPrintedPages[] = {{"/v1/jobs/{id}/report.html", "report", api::report_html},
                                         {"/v1/jobs/{id}/change-sheet.html", "change sheet", api::change_sheet_html}};

/// The parameter `controller`; "" if it is not given.
std::optional<Response> read_controller(const http::Request& request, const PrintedPage& page,
                                        std::string& controller) {
    api::Problem problem = bad_parameters(page.name);
    for (const auto& [name, value] : request.query) {
        if (name == "controller")
            controller = value;
        else
            refuse_parameter(problem, name, value, "the only parameter is controller, a number of the result.");
    }
    if (problem.errors.empty()) return std::nullopt;
    return problem_response(problem);
}

/// The address under which the client has reached the service.
std::string origin_of(const http::Request& request) {
    const std::string host(request.header("Host"));
    return host.empty() ? "" : "http://" + host;
}

Response page_of(const JobRecord& job, const Call& call, const std::string& controller, const PrintedPage& page) {
    if (!has_ended(job.status))
        return problem_response(
            409, "The job has not ended; its " + std::string(page.name) + " is available when it has succeeded.");
    if (job.result.empty())
        return problem_response(
            404, "The job " + job.id + " has ended as " + std::string(to_string(job.status)) + ", without a result.");
    const api::ReportWords words{
        .job = job.id,
        .name = job.name,
        .date = job.finished_at ? iso_time(*job.finished_at) : "",
        .origin = origin_of(call.request),
    };
    auto written = page.write({job.result, job.request}, controller, words);
    if (const auto* problem = std::get_if<api::Problem>(&written)) return problem_response(*problem);
    Response response;
    response.body = std::get<std::string>(std::move(written));
    response.set("Content-Type", "text/html; charset=utf-8");
    return response.set("Content-Security-Policy", api::report_policy());
}

Response get_page(JobService& jobs, ComputeSlots& readers, const Call& call, const PrintedPage& page) {
    if (!http::accepts(call.request, "text/html"))
        return problem_response(406, "The answer is text/html, which the Accept field does not allow.");
    std::string controller;
    if (auto refusal = read_controller(call.request, page, controller)) return *std::move(refusal);
    const std::string& id = call.path.at("id");
    return in_turn(readers, call.request, [&] {
        const std::optional<JobView> view = jobs.find(id);
        if (!view || !may_see(call.request, view->job)) return no_such_job(id);
        return page_of(view->job, call, controller, page);
    });
}

}  // namespace

void add_report_routes(http::Router& router, JobService& jobs, ComputeSlots& readers) {
    for (const PrintedPage& page : kPrintedPages)
        router.add("GET", page.path, [&](const Call& call) { return get_page(jobs, readers, call, page); });
}

}  // namespace tunewright::server
