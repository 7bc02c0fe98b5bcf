#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "api/batch/multipart.h"
#include "api/batch/plant_checks.h"
#include "api/csv/time_stamp.h"
#include "api/json/json.h"
#include "api/json/utf8.h"
#include "api/services/check_service.h"
#include "server/http/app/negotiation.h"
#include "server/http/app/problems.h"
#include "server/jobs/await.h"
#include "server/routes/batch_checks.h"
#include "server/routes/batch_results.h"
#include "server/routes/job_access.h"
#include "server/routes/job_json.h"
#include "server/routes/request_checks.h"
#include "server/routes/routes.h"

namespace tunewright::server {
namespace {

using http::Call;
using http::problem_response;
using http::Response;

constexpr std::size_t kMaxNameLength = 200;

/// The batch of the call, in the form that `answer` gives it.
template <class Answer>
Response about_batch(Batches& batches, const http::Request& request, const std::string& id, const Answer& answer) {
    return guarded([&] {
        const std::optional<BatchSummary> batch = batches.find(id);
        if (!batch || !may_see(request, *batch)) return no_such_batch(id);
        return answer(*batch);
    });
}

Response batch_response(Batches& batches, const http::Request& request, const std::string& id, int status,
                        const std::vector<std::string>& notes = {}) {
    return about_batch(batches, request, id, [&](const BatchSummary& batch) {
        return http::json_response(batch_json(batch, notes), status);
    });
}

std::optional<Response> refuse_stranger(Batches& batches, const Call& call) {
    Response found = batch_response(batches, call.request, call.path.at("id"), 200);
    if (found.status == 200) return std::nullopt;
    return found;
}

// ---- POST /v1/batches ------------------------------------------------------------------------------------------

/// The form according to the media type; empty without a refusal if the body's first bytes decide.
std::optional<Response> read_form(const http::Request& request, api::BatchQuestion& question) {
    std::optional<api::BatchForm>& form = question.form;
    const std::string type = http::media_type(request);
    if (type.empty() || type == "application/x-www-form-urlencoded" || type == "application/octet-stream")
        return std::nullopt;
    if (type == "application/json" || type.ends_with("+json")) {
        form = api::BatchForm::json;
    } else if (type == "application/x-ndjson" || type == "application/ndjson" || type == "application/jsonl" ||
               type == "application/x-jsonlines") {
        form = api::BatchForm::ndjson;
    } else if (type == "text/csv" || type == "application/csv" || type == "text/tab-separated-values") {
        form = api::BatchForm::csv;
    } else if (type == "multipart/form-data") {
        form = api::BatchForm::files;
        question.boundary = api::boundary_of(request.header("Content-Type"));
        constexpr std::size_t kMaxBoundary = 70;
        if (question.boundary.empty() || question.boundary.size() > kMaxBoundary)
            return problem_response(400, "The Content-Type must name the boundary of the parts.");
    } else {
        return problem_response(
            415,
            "The body must be application/json ({\"jobs\": [...]}), application/x-ndjson (one "
            "request per line), text/csv (one loop per line, or recorded loops with kind=check) or, with kind=check, "
            "multipart/form-data (files of recorded loops).");
    }
    return std::nullopt;
}

bool holds_records(const api::BatchQuestion& question) {
    const api::BatchForm form = question.form.value_or(api::BatchForm::csv);
    return question.kind == api::BatchKind::check && (form == api::BatchForm::csv || form == api::BatchForm::files);
}

/// Reads and checks the notification in the parameters.
std::optional<Response> judge_notify(NotifyPolicy& policy, const http::Request& request, BatchOrder& order) {
    order.question.judge_notify = [&policy](const api::Notify& notify) { return policy.refuse(notify, "notify."); };
    const auto url = request.query.find("notify_url"), secret = request.query.find("notify_secret_id");
    const std::string secret_id = secret == request.query.end() ? "" : secret->second;
    api::Problem problem = bad_parameters("batch");
    if (request.query.count("notify_url") > 1)
        refuse_parameter(problem, "notify_url", url->second, "it must be given once: a batch has one webhook.");
    if (url == request.query.end() && secret != request.query.end())
        refuse_parameter(problem, "notify_secret_id", secret_id, "it needs notify_url, which is missing.");
    if (!problem.errors.empty()) return http::problem_response(problem);
    if (url == request.query.end()) return std::nullopt;
    order.question.notify = api::Notify{url->second, secret_id};
    if (const auto refusal = policy.refuse(*order.question.notify, "notify_")) return http::problem_response(*refusal);
    return std::nullopt;
}

constexpr const char* kUnitsOfTime = "it must be a unit of time, such as ms, s, min or h.";

/// Reads the parameters about recorded loops. Everything else would be an option of a method, and a check has none.
std::optional<Response> read_kind(const http::Request& request, api::BatchQuestion& question) {
    const auto kind = request.query.find("kind");
    if (kind == request.query.end()) return std::nullopt;
    api::Problem problem = bad_parameters("batch");
    if (kind->second == "check")
        question.kind = api::BatchKind::check;
    else if (kind->second != "tune")
        refuse_parameter(problem, "kind", kind->second, "it must be tune or check.");
    for (const auto& [name, value] : std::exchange(question.options, {})) {
        if (question.kind == api::BatchKind::tune)
            question.options.emplace_back(name, value);
        else if (name == "units.time" && api::seconds_per(value))
            question.time_unit = value;
        else if (name == "units.time")
            refuse_parameter(problem, name, value, kUnitsOfTime);
        else if (name == "settings" && (value == "true" || value == "false"))
            question.settings = value == "true";
        else if (name == "settings")
            refuse_parameter(problem, name, value, "it must be true or false.");
        else
            refuse_parameter(problem, name, value,
                             "the only parameters of a check are kind, name, units.time, settings, notify_url "
                             "and notify_secret_id.");
    }
    if (!problem.errors.empty()) return http::problem_response(problem);
    return std::nullopt;
}

/// Reads head and parameters of the call.
std::optional<Response> read_order(const http::Request& request, NotifyPolicy& policy, const BatchLimits& limits,
                                   BatchOrder& order) {
    if (auto refusal = refuse_form(request)) return refusal;
    if (auto refusal = read_form(request, order.question)) return refusal;
    order.idempotency_key = request.header("Idempotency-Key");
    if (auto refusal = refuse_key(order.idempotency_key)) return refusal;
    for (const auto& [name, value] : request.query) {
        if (!api::is_utf8(name) || !api::is_utf8(value))
            return problem_response(422, "The parameters of the call are not valid UTF-8.");
        order.asked.append(name).append("=").append(value).append("\n");
        if (name == "name")
            order.question.name = value;
        else if (name != "notify_url" && name != "notify_secret_id" && name != "kind")
            order.question.options.emplace_back(name, value);
    }
    if (auto refusal = read_kind(request, order.question)) return refusal;
    if (order.question.form == api::BatchForm::files && !holds_records(order.question))
        return problem_response(422, "multipart/form-data has files of recorded loops. Add kind=check to the address.");
    if (auto refusal = judge_notify(policy, request, order)) return refusal;
    if (order.question.name.size() > kMaxNameLength)
        return problem_response(
            422, "name has " + std::to_string(order.question.name.size()) + " characters; at most 200 are accepted.");
    order.owner = request.owner.value_or("");
    order.flow = request.client;
    order.origin = {request.request_id, request.traceparent};
    order.question.limits = limits.job;
    order.question.longest_entry = limits.longest_entry;
    return std::nullopt;
}

Response receipt_response(Batches& batches, const http::Request& request, const BatchReceipt& receipt) {
    switch (receipt.kind) {
        case BatchReceipt::Kind::created:
        case BatchReceipt::Kind::existing: {
            Response response = batch_response(batches, request, receipt.id, 202, receipt.notes);
            if (response.status == 202) response.set("Location", "/v1/batches/" + receipt.id);
            return response;
        }
        case BatchReceipt::Kind::conflict:
            return problem_response(409, "This Idempotency-Key was used before with another batch. Use a new key.");
        case BatchReceipt::Kind::refused: return http::problem_response(receipt.problem);
        case BatchReceipt::Kind::queue_full:
            return problem_response(429, "The queue for entries of batches is full. Try again when some have ended.");
        case BatchReceipt::Kind::draining:
            return problem_response(503, "The service is being stopped and accepts no more jobs. Try again shortly.");
        case BatchReceipt::Kind::cancelled:
            return problem_response(409, "The batch was cancelled during its upload; none of it is kept.");
        case BatchReceipt::Kind::abandoned: return problem_response(400, "The body is incomplete.");
        case BatchReceipt::Kind::store_failed: break;
    }
    return store_failed(receipt.fault);
}

/// `recorded`: the place for a body of recorded loops, whose columns are in memory until all have arrived.
Response post_batch(Batches& batches, LongRequestSlots& places, LongRequestSlots& recorded, NotifyPolicy& policy,
                    const BatchLimits& limits, const Call& call) {
    BatchOrder order;
    if (auto refusal = read_order(call.request, policy, limits, order)) return *std::move(refusal);
    const auto place = places.take(call.request.client);
    if (!place) return problem_response(503, "Too many batches are being received. Try again in a moment.");
    std::optional<LongRequestSlots::Slot> alone;
    if (holds_records(order.question) && !(alone = recorded.take(call.request.client)))
        return problem_response(503, "Another file of recorded loops is being received. Try again in a moment.");
    return receipt_response(batches, call.request, batches.receive(std::move(order), call.request.read_body));
}

// ---- everything else -------------------------------------------------------------------------------------------

Response get_batch(Batches& batches, const Call& call) {
    if (auto refusal = refuse_form(call.request)) return *std::move(refusal);
    Response response = batch_response(batches, call.request, call.path.at("id"), 200);
    if (response.status == 200) http::apply_entity_tag(call.request, response, http::entity_tag(response.body));
    return response.set("Cache-Control", "no-cache");
}

Response list_batches(Batches& batches, ComputeSlots& listers, const Call& call) {
    if (auto refusal = refuse_form(call.request)) return *std::move(refusal);
    api::Problem problem = bad_parameters("list");
    int limit = 50;
    std::optional<std::int64_t> before;
    std::optional<std::string> owner = visible_owner(call.request);
    for (const auto& [name, value] : call.request.query) {
        if (name == "limit") {
            if (!read_whole(value, 1, kLargestPage, limit))
                refuse_parameter(problem, name, value, "it must be a whole number from 1 to 200.");
        } else if (name == "cursor") {
            if (!read_whole<std::int64_t>(value, 1, INT64_MAX, before.emplace()))
                refuse_parameter(problem, name, value, "it must come from the next link of an earlier page.");
        } else if (name == "owner" && call.request.admin) {
            owner = value;
        } else {
            refuse_parameter(problem, name, value,
                             "the only parameters of the list are limit and cursor, and owner for administrators.");
        }
    }
    if (!problem.errors.empty()) return http::problem_response(problem);
    return in_turn(listers, call.request,
                   [&] { return http::json_response(batch_page_json(batches.list(owner, limit, before), limit)); });
}

/// Reads the parameters for the results; a refusal if they are not valid.
std::optional<Response> read_results_question(const http::Request& request, ResultsQuestion& question) {
    api::Problem problem = bad_parameters("results");
    std::string format;
    for (const auto& [name, value] : request.query) {
        if (name == "format") {
            format = value;
            if (format != "ndjson" && format != "csv")
                refuse_parameter(problem, name, value, "it must be ndjson or csv.");
        } else if (name == "follow") {
            question.follow = value == "true";
            if (value != "true" && value != "false")
                refuse_parameter(problem, name, value, "it must be true or false.");
        } else if (name == "from") {
            if (!read_whole<std::int64_t>(value, 0, INT64_MAX, question.from))
                refuse_parameter(problem, name, value, "it must be the index of a request, a whole number >= 0.");
        } else {
            refuse_parameter(problem, name, value, "the only parameters of the results are format, follow and from.");
        }
    }
    if (!problem.errors.empty()) return http::problem_response(problem);
    const double ndjson = http::preference(request, "application/x-ndjson");
    const double csv = http::preference(request, "text/csv");
    question.csv = format.empty() ? csv > ndjson : format == "csv";
    if (format.empty() && ndjson == 0 && csv == 0)
        return problem_response(406,
                                "The results are application/x-ndjson or text/csv; the Accept field allows neither.");
    return std::nullopt;
}

/// True for a batch of checks, by the first of its requests that could be read.
bool is_of_checks(Batches& batches, JobService& jobs, const std::string& id) {
    constexpr std::int64_t kMaxLookedAt = 50;
    for (std::int64_t index = 0; index < kMaxLookedAt; ++index) {
        const std::vector<BatchRow> rows = batches.rows(id, index, 1);
        const std::optional<JobView> view = rows.empty() ? std::nullopt : jobs.find(rows.front().id);
        if (!view) return false;
        if (!view->job.request.empty()) return api::is_check_text(view->job.request);
    }
    return false;
}

Response get_results(Batches& batches, JobService& jobs, LongRequestSlots& places, Executor& lane, const Call& call) {
    ResultsQuestion question;
    question.batch = call.path.at("id");
    question.admitted = call.request.admitted;
    if (auto refusal = read_results_question(call.request, question)) return *std::move(refusal);
    if (auto refusal = refuse_stranger(batches, call)) return *std::move(refusal);
    Response response;
    if (question.csv) {
        question.of_checks = is_of_checks(batches, jobs, question.batch);
        response.set("Content-Type", "text/csv; charset=utf-8; header=present");
        response.set("Content-Disposition", "attachment; filename=\"batch-" + question.batch + ".csv\"");
    } else {
        response.set("Content-Type", "application/x-ndjson");
    }
    const auto place = std::make_shared<std::optional<LongRequestSlots::Slot>>(places.take(call.request.client));
    if (!*place) return problem_response(503, "Too many results are being sent. Try again in a moment.");
    response.stream = [place, send = results_of(std::move(question), batches, jobs, lane)](http::BodyWriter& out) {
        return send(out);
    };
    return response;
}

/// The batch that `before` names, or a refusal.
std::variant<std::optional<std::string>, Response> earlier_batch(const http::Request& request) {
    api::Problem problem = bad_parameters("check");
    std::optional<std::string> before;
    for (const auto& [name, value] : request.query) {
        if (name == "before")
            before = value;
        else
            refuse_parameter(problem, name, value, "the only parameter is before, an earlier batch of the same loops.");
    }
    if (!problem.errors.empty()) return problem_response(problem);
    return before;
}

Response check_of_batch(Batches& batches, const Call& call, const std::optional<std::string>& before) {
    const std::string& id = call.path.at("id");
    std::optional<BatchOfChecks> earlier;
    if (before) {
        auto read = read_checks(batches, call.request, *before);
        if (auto* refusal = std::get_if<Response>(&read)) return std::move(*refusal);
        earlier = std::get<BatchOfChecks>(std::move(read));
    }
    auto read = read_checks(batches, call.request, id);
    if (auto* refusal = std::get_if<Response>(&read)) return std::move(*refusal);
    const auto& now = std::get<BatchOfChecks>(read);
    return http::json_response(now.checks.answer(now.batch.ended(), earlier ? &earlier->checks : nullptr), 200);
}

Response get_check(Batches& batches, ComputeSlots& readers, const Call& call) {
    auto before = earlier_batch(call.request);
    if (auto* refusal = std::get_if<Response>(&before)) return std::move(*refusal);
    return in_turn(readers, call.request, [&] {
        return guarded([&] { return check_of_batch(batches, call, std::get<std::optional<std::string>>(before)); });
    });
}

Response cancel_batch(Batches& batches, const Call& call) {
    if (auto refusal = refuse_form(call.request)) return *std::move(refusal);
    if (auto refusal = refuse_stranger(batches, call)) return *std::move(refusal);
    const std::string& id = call.path.at("id");
    const auto outcome = await<Outcome<bool>>([&](const Done<bool>& done) { batches.cancel(id, done); });
    if (const auto* fault = std::get_if<StoreFault>(&outcome)) return store_failed(*fault);
    return batch_response(batches, call.request, id, 202);
}

Response delete_batch(Batches& batches, const Call& call) {
    if (auto refusal = refuse_form(call.request)) return *std::move(refusal);
    if (auto refusal = refuse_stranger(batches, call)) return *std::move(refusal);
    const std::string& id = call.path.at("id");
    const auto outcome =
        await<Outcome<RemoveEffect>>([&](const Done<RemoveEffect>& done) { batches.remove(id, done); });
    if (const auto* fault = std::get_if<StoreFault>(&outcome)) return store_failed(*fault);
    Response response;
    switch (std::get<RemoveEffect>(outcome)) {
        case RemoveEffect::not_ended:
            return problem_response(409,
                                    "The batch has not ended. Cancel it first: POST /v1/batches/" + id + "/cancel.");
        case RemoveEffect::none:
        case RemoveEffect::in_batch: return no_such_batch(id);
        case RemoveEffect::removed: break;
    }
    response.status = 204;
    return response;
}

}  // namespace

void add_batch_routes(http::Router& router, Batches& batches, JobService& jobs, LongRequestSlots& places,
                      ComputeSlots& listers, Executor& lane, NotifyPolicy& policy, const BatchLimits& limits) {
    const auto recorded = std::make_shared<LongRequestSlots>(std::array<std::size_t, 2>{1, 1});
    router.streamed("POST", "/v1/batches", [&batches, &places, &policy, limits, recorded](const Call& call) {
        return post_batch(batches, places, *recorded, policy, limits, call);
    });
    router.add("GET", "/v1/batches", [&](const Call& call) { return list_batches(batches, listers, call); });
    router.add("GET", "/v1/batches/{id}", [&](const Call& call) { return get_batch(batches, call); });
    router.add("DELETE", "/v1/batches/{id}", [&](const Call& call) { return delete_batch(batches, call); });
    router.add("GET", "/v1/batches/{id}/results", [&](const Call& call) {
        return guarded([&] { return get_results(batches, jobs, places, lane, call); });
    });
    router.add("GET", "/v1/batches/{id}/check", [&](const Call& call) { return get_check(batches, listers, call); });
    router.add("POST", "/v1/batches/{id}/cancel", [&](const Call& call) { return cancel_batch(batches, call); });
}

}  // namespace tunewright::server
