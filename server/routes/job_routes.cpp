#include <future>
#include <memory>
#include <variant>

#include "api/service.h"
#include "server/http/app/negotiation.h"
#include "server/http/app/problems.h"
#include "server/jobs/await.h"
#include "server/routes/job_access.h"
#include "server/routes/job_json.h"
#include "server/routes/job_submission.h"
#include "server/routes/request_checks.h"
#include "server/routes/routes.h"

namespace tunewright::server {
namespace {

using http::Call;
using http::problem_response;
using http::Response;

constexpr std::size_t kMinLargeBody = 256 * 1024;  // bytes of a body that is read in a turn

Response job_response(JobService& jobs, ComputeSlots& readers, const http::Request& request, const std::string& id,
                      int status) {
    return in_turn(readers, request, [&] {
        const std::optional<JobView> view = jobs.find(id);
        if (!view || !may_see(request, view->job)) return no_such_job(id);
        return http::json_response(job_json(*view), status);
    });
}

Response submitted(const JobService& jobs, const Submission& submission) {
    if (auto refusal = refuse_submission(jobs, submission)) return *std::move(refusal);
    Response response = http::json_response(job_json({submission.job, std::nullopt}), 202);
    return response.set("Location", "/v1/jobs/" + submission.job.id);
}

/// The answer after a wait: 200 with the job if it has ended, otherwise 202, as without a wait.
Response waited(const JobView& view, std::optional<std::chrono::seconds> wait) {
    const bool ended = wait && has_ended(view.job.status);
    Response response = http::json_response(job_json(view), ended ? 200 : 202);
    if (wait) response.set("Preference-Applied", "wait=" + std::to_string(wait->count()));
    return response.set("Location", "/v1/jobs/" + view.job.id);
}

Response waited(JobService& jobs, ComputeSlots& readers, const http::Request& request, const std::string& id,
                std::optional<std::chrono::seconds> wait) {
    return in_turn(readers, request, [&] {
        const std::optional<JobView> view = jobs.find(id);
        return view ? waited(*view, wait) : no_such_job(id);
    });
}

/// The answer about an existing job: at once, or when it has ended or the wait is over.
Response after_wait(JobService& jobs, ComputeSlots& readers, const http::Request& request, const std::string& id,
                    std::chrono::seconds wait) {
    if (wait.count() == 0) return waited(jobs, readers, request, id, std::nullopt);
    try {
        const auto wait_for_end = [&](const std::function<void()>& ended) {
            jobs.wait(id, wait, [ended](const auto&) { ended(); });
        };
        if (!await_end(wait_for_end, request.left)) return client_gone();
    } catch (const StoreError& error) {
        return store_failed({error.kind, error.what()});
    }
    return waited(jobs, readers, request, id, wait);
}

std::optional<Response> refuse_parameters(const http::Request& request) {
    api::Problem problem = bad_parameters("call");
    for (const auto& [name, value] : request.query)
        refuse_parameter(
            problem, name, value,
            "this call has no parameters: the request is in the body, and the time to wait in the field Prefer.");
    if (problem.errors.empty()) return std::nullopt;
    return http::problem_response(problem);
}

/// A large body takes a turn like a computation: reading it may take a second.
std::variant<api::PreparedJob, api::Problem, Response> prepared_in_turn(ComputeSlots& computing,
                                                                        const http::Request& request,
                                                                        const api::JobLimits& limits) {
    std::variant<api::PreparedJob, api::Problem, Response> made;
    const auto prepare = [&] {
        std::visit([&](auto&& value) { made = std::forward<decltype(value)>(value); },
                   api::prepare_job(request.body, limits));
    };
    if (request.body.size() <= kMinLargeBody) {
        prepare();
        return made;
    }
    Response refusal = in_turn(computing, request, [&] {
        prepare();
        return Response();
    });
    if (refusal.status != 200) made = std::move(refusal);
    return made;
}

Response post_job(JobService& jobs, LongRequestSlots& places, const SharedTurns& turns, NotifyPolicy& policy,
                  const api::JobLimits& limits, Call& call) {
    if (auto refusal = refuse_call(call.request)) return *std::move(refusal);
    const std::string key(call.request.header("Idempotency-Key"));
    if (auto refusal = refuse_key(key)) return *std::move(refusal);
    if (auto refusal = refuse_parameters(call.request)) return *std::move(refusal);
    auto prepared = prepared_in_turn(turns.computing, call.request, limits);
    if (auto* refusal = std::get_if<Response>(&prepared)) return std::move(*refusal);
    if (const auto* problem = std::get_if<api::Problem>(&prepared)) return http::problem_response(*problem);

    Order order;
    order.job = std::get<api::PreparedJob>(std::move(prepared));
    if (order.job.unique && !key.empty())
        return problem_response(422, "The request has unique and an Idempotency-Key. Remove one.");
    if (order.job.notify)
        if (const auto problem = policy.refuse(*order.job.notify, "notify.")) return http::problem_response(*problem);
    order.idempotency_key = key;
    order.owner = call.request.owner.value_or("");
    order.flow = call.request.client;
    order.origin = {call.request.request_id, call.request.traceparent};
    // If too many already wait, this client does not: it gets its job at once, as without the preference.
    std::chrono::seconds wait = http::preferred_wait(call.request).value_or(std::chrono::seconds(0));
    std::optional<LongRequestSlots::Slot> place;
    if (wait.count() > 0 && !(place = places.take(call.request.client))) wait = {};
    order.wait = wait;
    std::string().swap(call.request.body);
    if (call.request.keep) call.request.keep(kStoredCopies * order.job.request_json.size());
    const auto made = submit(jobs, std::move(order), call.request);
    if (!made) return client_gone();
    const auto& [submission, ended] = *made;
    if (submission.kind == Submission::Kind::existing)
        return after_wait(jobs, turns.readers, call.request, submission.job.id, wait);
    if (submission.kind != Submission::Kind::created || wait.count() == 0) return submitted(jobs, submission);
    if (ended) return waited(JobView{*ended, std::nullopt}, wait);
    return waited(jobs, turns.readers, call.request, submission.job.id, wait);
}

/// A job that has ended does not change, so its tag does not depend on its result.
std::string entity_tag_of(const JobSummary& job, const std::string& body) {
    if (!has_ended(job.status)) return http::entity_tag(body);
    std::string tag = "\"" + job.id + "-" + std::to_string(job.attempts) + "-";
    return tag.append(std::to_string(job.finished_at.value_or(0))).append("-" TUNEWRIGHT_VERSION "\"");
}

/// 304 for a client that already has an ended job, without reading its request and result.
std::optional<Response> unchanged(JobService& jobs, const Call& call) {
    if (!call.request.has_header("If-None-Match")) return std::nullopt;
    const std::optional<JobState> state = jobs.state(call.path.at("id"));
    if (!state || !has_ended(state->status) || !may_see(call.request, *state)) return std::nullopt;
    Response response;
    http::apply_entity_tag(call.request, response, entity_tag_of(*state, ""));
    if (response.status != 304) return std::nullopt;
    return response;
}

Response get_job(JobService& jobs, ComputeSlots& readers, const Call& call) {
    if (auto refusal = refuse_form(call.request)) return *std::move(refusal);
    const std::string& id = call.path.at("id");
    Response response = in_turn(readers, call.request, [&] {
        if (auto same = unchanged(jobs, call)) return *std::move(same);
        const std::optional<JobView> view = jobs.find(id);
        if (!view || !may_see(call.request, view->job)) return no_such_job(id);
        Response found = http::json_response(job_json(*view));
        http::apply_entity_tag(call.request, found, entity_tag_of(view->job, found.body));
        return found;
    });
    // It may be cached if it is revalidated each time.
    return response.set("Cache-Control", "no-cache");
}

/// Reads the list's parameters into `query`, and their faults into the problem.
api::Problem read_query(const http::Request& request, JobQuery& query) {
    api::Problem problem = bad_parameters("list");
    for (const auto& [name, value] : request.query) {
        const auto refuse = [&, &key = name, &given = value](const std::string& rule) {
            refuse_parameter(problem, key, given, rule);
        };
        if (name == "status") {
            query.status = job_status(value);
            if (!query.status) refuse("it must be one of queued, running, succeeded, failed, cancelled.");
        } else if (name == "name") {
            query.name = value;
        } else if (name == "q") {
            query.text = value;
        } else if (name == "batch") {
            query.batch = value;
        } else if (name == "limit") {
            if (!read_whole(value, 1, kLargestPage, query.limit)) refuse("it must be a whole number from 1 to 200.");
        } else if (name == "cursor") {
            query.before_seq = parse_cursor(value);
            if (!query.before_seq) refuse("it must come from the next link of an earlier page.");
        } else if (name == "owner" && request.admin) {
            query.owner = value;
        } else {
            refuse(
                "the only parameters of the list are status, name, q, batch, limit and cursor, and owner for "
                "administrators.");
        }
    }
    return problem;
}

Response list_jobs(JobService& jobs, const SharedTurns& turns, const Call& call) {
    if (auto refusal = refuse_form(call.request)) return *std::move(refusal);
    JobQuery query;
    query.owner = visible_owner(call.request);
    const api::Problem problem = read_query(call.request, query);
    if (!problem.errors.empty()) return http::problem_response(problem);
    const auto list = [&] {
        return in_turn(turns.listers, call.request,
                       [&] { return http::json_response(job_page_json(jobs.list(query), query, call.request.admin)); });
    };
    return query.text ? in_turn(turns.searchers, call.request, list) : list();
}

Response cancel_job(JobService& jobs, ComputeSlots& readers, const Call& call) {
    if (auto refusal = refuse_call(call.request)) return *std::move(refusal);
    if (auto refusal = refuse_stranger(jobs, call)) return *std::move(refusal);
    const std::string& id = call.path.at("id");
    const auto outcome = await<Outcome<CancelEffect>>([&](const Done<CancelEffect>& done) { jobs.cancel(id, done); });
    if (const auto* fault = std::get_if<StoreFault>(&outcome)) return store_failed(*fault);
    return job_response(jobs, readers, call.request, id, 202);
}

/// The answer if the job was not queued again.
Response not_requeued(const JobService& jobs, const std::string& id, RequeueEffect effect) {
    if (effect == RequeueEffect::queue_full) return queue_full(jobs);
    if (effect == RequeueEffect::batch_cancelled)
        return problem_response(409, "The batch of this job was cancelled as a whole. Post its request again.");
    if (effect == RequeueEffect::superseded)
        return problem_response(409,
                                "A later job with this request, which is unique, has replaced this one. Post the "
                                "request again: the answer is that job.");
    if (effect == RequeueEffect::not_failed)
        return problem_response(409,
                                "Only a job that failed or was cancelled, and whose request could be read, can be "
                                "queued again. Post its request again.");
    return no_such_job(id);
}

Response requeue_job(JobService& jobs, ComputeSlots& readers, const Call& call) {
    if (auto refusal = refuse_call(call.request)) return *std::move(refusal);
    if (auto refusal = refuse_stranger(jobs, call)) return *std::move(refusal);
    const std::string& id = call.path.at("id");
    return guarded([&] {
        const auto outcome =
            await<Outcome<RequeueEffect>>([&](const Done<RequeueEffect>& done) { jobs.requeue(id, done); });
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) return store_failed(*fault);
        const auto effect = std::get<RequeueEffect>(outcome);
        if (effect != RequeueEffect::requeued) return not_requeued(jobs, id, effect);
        return job_response(jobs, readers, call.request, id, 202);
    });
}

/// 412 if If-Match names another state of the job than that with which it ended.
std::optional<Response> refuse_other_state(JobService& jobs, const Call& call) {
    if (!call.request.has_header("If-Match")) return std::nullopt;
    const std::string& id = call.path.at("id");
    Response found = guarded([&] {
        const std::optional<JobState> state = jobs.state(id);
        if (!state) return no_such_job(id);
        // A job that has not ended is not deleted, whatever its tag.
        if (!has_ended(state->status) || http::matches_entity_tag(call.request, entity_tag_of(*state, "")))
            return Response();
        return problem_response(412, "The job has changed since the answer whose ETag is in If-Match. Read it again.");
    });
    if (found.status == 200) return std::nullopt;
    return found;
}

Response delete_job(JobService& jobs, const Call& call) {
    if (auto refusal = refuse_call(call.request)) return *std::move(refusal);
    if (auto refusal = refuse_stranger(jobs, call)) return *std::move(refusal);
    const std::string& id = call.path.at("id");
    if (auto refusal = refuse_other_state(jobs, call)) return *std::move(refusal);
    const auto outcome = await<Outcome<RemoveEffect>>([&](const Done<RemoveEffect>& done) { jobs.remove(id, done); });
    if (const auto* fault = std::get_if<StoreFault>(&outcome)) return store_failed(*fault);
    Response response;
    switch (std::get<RemoveEffect>(outcome)) {
        case RemoveEffect::none: return no_such_job(id);
        case RemoveEffect::not_ended:
            return problem_response(409, "The job has not ended. Cancel it first: POST /v1/jobs/" + id + "/cancel.");
        case RemoveEffect::in_batch:
            return problem_response(409, "The job belongs to a batch. Delete the batch as a whole.");
        case RemoveEffect::removed: break;
    }
    response.status = 204;
    return response;
}

}  // namespace

void add_job_routes(http::Router& router, JobService& jobs, LongRequestSlots& places, const SharedTurns& turns,
                    NotifyPolicy& policy, const api::JobLimits& limits) {
    router.add("POST", "/v1/jobs", [&jobs, &places, turns, &policy, limits](Call& call) {
        return post_job(jobs, places, turns, policy, limits, call);
    });
    router.add("GET", "/v1/jobs", [&jobs, turns](const Call& call) { return list_jobs(jobs, turns, call); });
    router.add("GET", "/v1/jobs/{id}",
               [&jobs, &readers = turns.readers](const Call& call) { return get_job(jobs, readers, call); });
    router.add("DELETE", "/v1/jobs/{id}", [&](const Call& call) { return delete_job(jobs, call); });
    router.add("POST", "/v1/jobs/{id}/cancel",
               [&jobs, &readers = turns.readers](const Call& call) { return cancel_job(jobs, readers, call); });
    router.add("POST", "/v1/jobs/{id}/requeue",
               [&jobs, &readers = turns.readers](const Call& call) { return requeue_job(jobs, readers, call); });
}

}  // namespace tunewright::server
