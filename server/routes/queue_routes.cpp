// The administrator's view of the queue, and the calls that pause and resume it.
#include "server/http/app/problems.h"
#include "server/jobs/await.h"
#include "server/json_text.h"
#include "server/routes/job_access.h"
#include "server/routes/request_checks.h"
#include "server/routes/routes.h"

namespace tunewright::server {
namespace {

using http::Call;
using http::Response;

std::optional<Response> refuse_others(const Call& call) {
    if (auto refusal = refuse_call(call.request)) return refusal;
    if (call.request.admin) return std::nullopt;
    return http::problem_response(403,
                                  "Only an administrator may do this: with a key made by `tunewright key NAME "
                                  "--admin`, or without keys from the service's own machine.");
}

std::string queue_json(const JobService& jobs) {
    const QueueDepth depth = jobs.depth();
    const auto number = [](std::size_t count) { return static_cast<std::int64_t>(count); };
    JsonObject queued;
    queued.number("single", number(depth.single))
        .number("batch", number(depth.entries))
        .number("alone", number(depth.suspects));
    const auto since = [](const std::optional<UnixMs>& time) { return time ? json_string(iso_time(*time)) : "null"; };
    JsonObject next;
    next.raw("single", since(depth.next_single)).raw("batch", since(depth.next_entry));
    JsonObject here;
    here.number("running", number(jobs.running())).number("workers", number(jobs.workers()));
    JsonObject queue;
    queue.boolean("paused", depth.paused)
        .raw("queued", std::move(queued).str())
        .raw("next_accepted_at", std::move(next).str())
        .raw("this_process", std::move(here).str());
    return std::move(queue).str();
}

Response pause(JobService& jobs, const Call& call, bool paused) {
    if (auto refusal = refuse_others(call)) return *std::move(refusal);
    const auto outcome = await<Outcome<bool>>([&](const Done<bool>& done) { jobs.pause(paused, done); });
    if (const auto* fault = std::get_if<StoreFault>(&outcome)) return store_failed(*fault);
    return http::json_response(paused ? R"({"paused":true})" : R"({"paused":false})");
}

}  // namespace

void add_queue_routes(http::Router& router, JobService& jobs) {
    router.quick("GET", "/v1/queue", [&](const Call& call) {
        if (auto refusal = refuse_others(call)) return *std::move(refusal);
        return http::json_response(queue_json(jobs)).set("Cache-Control", "no-store");
    });
    router.quick("POST", "/v1/queue/pause", [&](const Call& call) { return pause(jobs, call, true); });
    router.quick("POST", "/v1/queue/resume", [&](const Call& call) { return pause(jobs, call, false); });
}

}  // namespace tunewright::server
