#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "api/report/change_sheet.h"
#include "api/report/report.h"
#include "server/http/app/negotiation.h"
#include "server/http/app/problems.h"
#include "server/json_text.h"
#include "server/routes/batch_checks.h"
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

/// The parameters of a page.
struct PageQuestion {
    std::string controller;  ///< "" if it is not given
    std::int64_t from = 0;   ///< the first loop of a batch
    std::optional<int> utc_offset_min;
};

/// Reads the parameters; `selects`: the one that a page has in addition to utc_offset, and its rule; null: none.
std::optional<Response> read_question(const http::Request& request, const char* name_of_page, const char* selects,
                                      PageQuestion& question) {
    api::Problem problem = bad_parameters(name_of_page);
    for (const auto& [name, value] : request.query) {
        if (name == "utc_offset") {
            if (!read_whole(value, -api::kMaxUtcOffset, api::kMaxUtcOffset, question.utc_offset_min.emplace()))
                refuse_parameter(problem, name, value, "it must be minutes ahead of UTC, a whole number up to 840.");
        } else if (selects == nullptr) {
            refuse_parameter(problem, name, value, "the only parameter is utc_offset.");
        } else if (name != selects) {
            refuse_parameter(problem, name, value,
                             std::string("the only parameters are ") + selects + " and utc_offset.");
        } else if (name == "controller") {
            question.controller = value;
        } else if (!read_whole<std::int64_t>(value, 0, INT64_MAX, question.from)) {
            refuse_parameter(problem, name, value, "it must be the index of a request, a whole number >= 0.");
        }
    }
    if (problem.errors.empty()) return std::nullopt;
    return problem_response(problem);
}

/// The address under which the client has reached the service.
std::string origin_of(const http::Request& request) {
    const std::string host(request.header("Host"));
    return host.empty() ? "" : "http://" + host;
}

api::ReportWords report_words(const JobRecord& job, const Call& call, const PageQuestion& question) {
    return {.job = job.id,
            .name = job.name,
            .date = job.finished_at ? iso_time(*job.finished_at) : "",
            .origin = origin_of(call.request),
            .utc_offset_min = question.utc_offset_min};
}

Response html_response(std::string text) {
    Response response;
    response.body = std::move(text);
    response.set("Content-Type", "text/html; charset=utf-8");
    return response.set("Content-Security-Policy", api::report_policy());
}

Response page_of(const JobRecord& job, const Call& call, const PageQuestion& question, const PrintedPage& page) {
    if (!has_ended(job.status))
        return problem_response(
            409, "The job has not ended; its " + std::string(page.name) + " is available when it has succeeded.");
    if (job.result.empty())
        return problem_response(
            404, "The job " + job.id + " has ended as " + std::string(to_string(job.status)) + ", without a result.");
    auto written = page.write({job.result, job.request}, question.controller, report_words(job, call, question));
    if (const auto* problem = std::get_if<api::Problem>(&written)) return problem_response(*problem);
    return html_response(std::get<std::string>(std::move(written)));
}

constexpr const char* kNotHtml = "The answer is text/html, which the Accept field does not allow.";

Response get_page(JobService& jobs, ComputeSlots& readers, const Call& call, const PrintedPage& page) {
    if (!http::accepts(call.request, "text/html")) return problem_response(406, kNotHtml);
    PageQuestion question;
    if (auto refusal = read_question(call.request, page.name, "controller", question)) return *std::move(refusal);
    const std::string& id = call.path.at("id");
    return in_turn(readers, call.request, [&] {
        const std::optional<JobView> view = jobs.find(id);
        if (!view || !may_see(call.request, view->job)) return no_such_job(id);
        return page_of(view->job, call, question, page);
    });
}

/// Loops of one answer, and the size from which on the rest is left to the next.
constexpr std::size_t kMaxLoops = 100, kMaxSheetBytes = std::size_t{4} << 20;

/// Adds the loops from `next` on, and moves it behind the last of them. False: the batch was deleted meanwhile.
bool add_sheets(Batches& batches, JobService& jobs, const Call& call, const PageQuestion& question, std::int64_t& next,
                api::ChangeSheets& sheets) {
    const std::string& id = call.path.at("id");
    while (sheets.loops() < kMaxLoops && sheets.bytes() < kMaxSheetBytes) {
        const std::vector<BatchRow> rows = batches.rows(id, next, kMaxLoops - sheets.loops());
        if (rows.empty()) return true;
        for (const BatchRow& row : rows) {
            const std::optional<JobView> view = jobs.find(row.id);
            if (!view || row.index != next) return false;
            const JobRecord& job = view->job;
            sheets.add({row.index,
                        to_string(job.status),
                        {job.result, job.request},
                        job.error,
                        report_words(job, call, question)});
            ++next;
            if (sheets.bytes() >= kMaxSheetBytes) return true;
        }
    }
    return true;
}

Response batch_page(Batches& batches, JobService& jobs, const Call& call, const PageQuestion& question) {
    const std::string& id = call.path.at("id");
    const std::optional<BatchSummary> batch = batches.find(id);
    if (!batch || !may_see(call.request, *batch)) return no_such_batch(id);
    const auto total = static_cast<std::int64_t>(batch->total);
    if (question.from > 0 && question.from >= total)
        return problem_response(404, "The batch has " + std::to_string(total) + " loops; from must be below that.");
    api::ChangeSheets sheets;
    std::int64_t next = question.from;
    if (!add_sheets(batches, jobs, call, question, next, sheets)) return no_such_batch(id);
    std::string address;
    if (next < total) {
        address = "change-sheet.html?from=" + std::to_string(next);
        if (question.utc_offset_min) address += "&utc_offset=" + std::to_string(*question.utc_offset_min);
    }
    return html_response(sheets.page(batch->name.empty() ? "Batch" : batch->name, address));
}

Response get_batch_page(Batches& batches, JobService& jobs, ComputeSlots& readers, const Call& call) {
    if (!http::accepts(call.request, "text/html")) return problem_response(406, kNotHtml);
    PageQuestion question;
    if (auto refusal = read_question(call.request, "change sheets", "from", question)) return *std::move(refusal);
    return in_turn(readers, call.request, [&] { return batch_page(batches, jobs, call, question); });
}

/// Words for the report of a batch, in which the batch stands in the place of the job.
api::ReportWords batch_words(const BatchSummary& batch, const Call& call, const PageQuestion& question) {
    return {.job = "",
            .name = batch.name,
            .date = iso_time(batch.finished_at.value_or(batch.created_at)),
            .origin = origin_of(call.request),
            .utc_offset_min = question.utc_offset_min};
}

/// Only the loops with a page of their own are read a second time, for their drawings.
Response report_of_batch(Batches& batches, const Call& call, const PageQuestion& question) {
    const std::string& id = call.path.at("id");
    auto read = read_checks(batches, call.request, id, api::PlantChecks::Kept::none);
    if (auto* refusal = std::get_if<Response>(&read)) return std::move(*refusal);
    const auto& [batch, checks] = std::get<BatchOfChecks>(read);
    api::BatchReport report(checks.answer(batch.ended(), nullptr));
    for (const std::size_t loop : report.pages()) {
        const api::PlantChecks::Source& source = checks.source(loop);
        const std::vector<BatchRow> rows = batches.rows(id, source.index, 1);
        if (rows.empty() || rows.front().index != source.index) return no_such_batch(id);
        report.add_drawings(loop, rows.front().result, source.place);
    }
    for (const auto& [name, reason] : checks.failed()) report.add_failed(name, reason);
    return html_response(report.html(batch.name, batch_words(batch, call, question)));
}

Response get_batch_report(Batches& batches, ComputeSlots& readers, const Call& call) {
    if (!http::accepts(call.request, "text/html")) return problem_response(406, kNotHtml);
    PageQuestion question;
    if (auto refusal = read_question(call.request, "report", nullptr, question)) return *std::move(refusal);
    return in_turn(readers, call.request, [&] { return report_of_batch(batches, call, question); });
}

}  // namespace

void add_report_routes(http::Router& router, JobService& jobs, Batches& batches, ComputeSlots& readers) {
    for (const PrintedPage& page : kPrintedPages)
        router.add("GET", page.path, [&](const Call& call) { return get_page(jobs, readers, call, page); });
    router.add("GET", "/v1/batches/{id}/change-sheet.html",
               [&](const Call& call) { return get_batch_page(batches, jobs, readers, call); });
    router.add("GET", "/v1/batches/{id}/report.html",
               [&](const Call& call) { return get_batch_report(batches, readers, call); });
}

}  // namespace tunewright::server
