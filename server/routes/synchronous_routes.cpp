#include <algorithm>
#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>

#include <fmt/format.h>

#include "api/certificate/certificate_call.h"
#include "api/check_service.h"
#include "api/registries.h"
#include "api/service.h"
#include "api/services/range_service.h"
#include "api/services/score_service.h"
#include "api/services/structure_service.h"
#include "api/services/verify/verify_call.h"
#include "server/clock.h"
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
using SyncCall = std::function<api::Answer(const Call&, const RunControl&)>;

using Refusal = std::optional<Response> (*)(const http::Request&);

constexpr std::chrono::seconds kEvaluateTime{10};
constexpr std::chrono::seconds kDesignTime{10};
constexpr std::chrono::seconds kRangeTime{20};
constexpr std::chrono::seconds kStructureTime{20};
constexpr std::chrono::seconds kIdentifyTime{30};
constexpr std::chrono::seconds kCheckTime{30};
constexpr std::chrono::seconds kScoreTime{60};
constexpr std::chrono::seconds kVerifyTime{60};
constexpr std::chrono::seconds kRelayTime{10};
constexpr std::chrono::seconds kConversionTime{10};
constexpr std::chrono::seconds kCertificateTime{120};
constexpr std::chrono::milliseconds kGonePollInterval{250};  // between checks for clients that have disconnected

bool is_file(const http::Request& request) {
    const std::string type = http::media_type(request);
    return type == "text/csv" || type == "application/csv" || type == "text/tab-separated-values" ||
           type == "text/plain" || type == "application/octet-stream";
}

Response too_slow(std::chrono::seconds limit) {
    Error error;
    error.kind = ErrorKind::timeout;
    error.message = "The computation was stopped after " + std::to_string(limit.count()) +
                    " s. Reduce the request, or post it as a job, which may take longer.";
    return http::problem_response(api::to_problem(error));
}

/// The answer to a call that was never begun.
Response too_busy(std::chrono::seconds limit) {
    return problem_response(
        503,
        "The service was busy with other computations for " + std::to_string(limit.count()) +
            " s, and this one was not started. Try again in a moment, or post it as a job, which waits for its turn.");
}

Response closing_down() { return problem_response(503, "The service is being stopped. Try again shortly."); }

/// Stops a computation at its deadline, when the service stops, or when its client has disconnected.
class ComputationWatchdog : public std::enable_shared_from_this<ComputationWatchdog> {
public:
    ComputationWatchdog(Timer& timer, ComputeSlots::Clock::time_point deadline, std::function<bool()> left)
        : timer_(timer), deadline_(deadline), left_(std::move(left)) {}

    void look() {
        const std::lock_guard lock(mutex_);
        if (over_) return;
        gone_ = left_ && left_();
        if (gone_ || ComputeSlots::Clock::now() >= deadline_) return stop();
        look_later();
    }
    /// Short computations are not watched: the first check comes after a while.
    void look_later() {
        const std::chrono::duration<double> rest = deadline_ - ComputeSlots::Clock::now();
        timer_.after(std::min<std::chrono::duration<double>>(kGonePollInterval, rest),
                     [self = shared_from_this()] { self->look(); });
    }
    void stop() { stop_.request_stop(); }
    /// From now on the client is not checked.
    void end() {
        const std::lock_guard lock(mutex_);
        over_ = true;
    }
    /// True if it was stopped because the client has disconnected.
    bool gone() const { return gone_; }
    std::stop_token token() const { return stop_.get_token(); }

private:
    Timer& timer_;
    const ComputeSlots::Clock::time_point deadline_;
    const std::function<bool()> left_;
    std::stop_source stop_;
    std::mutex mutex_;
    bool over_ = false;
    std::atomic<bool> gone_ = false;
};

/// The answer of `work`, which runs on this thread when its turn has come.
Response compute(const SyncCall& work, const Call& call, std::chrono::seconds limit, SpareCores& spare_cores,
                 const std::shared_ptr<ComputationWatchdog>& watchdog, const std::stop_token& closing) {
    const std::stop_callback on_closing(closing, [watchdog] { watchdog->stop(); });
    RunControl control;
    control.stop = watchdog->token();
    control.now_ms = monotonic_ms;
    SpareCores::Computation computation(spare_cores);
    control.spread = computation.spread();
    const double start = monotonic_ms();
    api::Answer answer = work(call, control);
    if (answer.status >= 400 && closing.stop_requested()) return closing_down();
    if (answer.status >= 400 && watchdog->gone()) return client_gone();
    if (answer.status >= 400 && control.stop.stop_requested()) return too_slow(limit);

    Response response = response_of(std::move(answer));
    response.set("Server-Timing", fmt::format("compute;dur={:.2f}", monotonic_ms() - start));
    return response;
}

/// The body is a file of a recorded test, or JSON that contains it.
std::optional<Response> refuse_file_call(const http::Request& request) {
    if (!is_file(request) && !http::sends_json(request))
        return problem_response(415, "The body must be the file itself, with Content-Type: text/csv, or JSON.");
    return refuse_form(request);
}

api::Answer preview(const Call& call, const RunControl&) {
    return is_file(call.request) ? api::preview_file(call.request.body) : api::preview_call(call.request.body);
}

/// The time limit counts from the arrival of the request, including the wait for its turn.
http::Handler synchronous(const SyncCall& work, std::chrono::seconds limit, ComputeSlots& turns, Timer& timer,
                          SpareCores& spare_cores, const std::stop_token& closing, Refusal refuse) {
    return [=, &turns, &timer, &spare_cores](const Call& call) {
        const auto deadline = ComputeSlots::Clock::now() + limit;
        if (auto refusal = refuse(call.request)) return *std::move(refusal);
        if (closing.stop_requested()) return closing_down();
        switch (turns.take(call.request.client, deadline, call.request.left)) {
            case ComputeSlots::Wait::full:
                return problem_response(429, "Too many computations are waiting. Try again after a moment.");
            case ComputeSlots::Wait::late: return too_busy(limit);
            case ComputeSlots::Wait::left: return client_gone();
            case ComputeSlots::Wait::granted: break;
        }
        const auto watchdog = std::make_shared<ComputationWatchdog>(timer, deadline, call.request.left);
        watchdog->look_later();
        const std::shared_ptr<void> ended(nullptr, [&, client = call.request.client](void*) {
            watchdog->end();
            turns.give_back(client);
        });
        return compute(work, call, limit, spare_cores, watchdog, closing);
    };
}

/// A call whose only input is its body.
SyncCall of_body(api::Answer (*work)(std::string_view, const RunControl&)) {
    return [work](const Call& call, const RunControl& control) { return work(call.request.body, control); };
}

/// A conversion for the product in the path.
SyncCall of_product(api::Answer (*work)(std::string_view, std::string_view)) {
    return [work](const Call& call, const RunControl&) { return work(call.path.at("id"), call.request.body); };
}

/// The certificate's file of a job whose result holds a certificate.
api::Answer certificate_of(JobService& jobs, const Call& call, const RunControl& control) {
    const auto view = jobs.find(call.path.at("id"));
    if (!view || !may_see(call.request, view->job)) return api::refusal(http::problem(404, "There is no such job."));
    const JobRecord& job = view->job;
    if (job.result.empty()) return api::refusal(http::problem(409, "The job " + job.id + " has no result yet."));
    const auto file = api::certificate_file({job.result, job.request}, call.path.at("index"), control);
    if (const auto* problem = std::get_if<api::Problem>(&file)) return api::refusal(*problem);
    return {200, std::get<std::string>(file)};
}

std::optional<Response> no_body(const http::Request&) { return std::nullopt; }

/// The answer of `handler` as a file to keep.
http::Handler as_file(http::Handler handler, const std::string& media_type, const std::string& name) {
    return [=](Call& call) {
        Response response = handler(call);
        if (response.status != 200) return response;
        response.set("Content-Type", media_type);
        return response.set("Content-Disposition", "attachment; filename=\"" + name + "\"");
    };
}

/// Answered at once: while a user types, it is called at each key, and does not wait for computations.
Response parse_plant(const Call& call) {
    if (auto refusal = refuse_call(call.request)) return *std::move(refusal);
    return response_of(api::parse_plant_call(call.request.body));
}

}  // namespace

void add_synchronous_routes(http::Router& router, JobService& jobs, ComputeSlots& turns, Timer& timer,
                            SpareCores& spare_cores, const std::stop_token& closing) {
    const auto add = [&](const char* path, const SyncCall& work, std::chrono::seconds limit,
                         Refusal refuse = refuse_call) {
        router.add("POST", path, synchronous(work, limit, turns, timer, spare_cores, closing, refuse));
    };
    const auto certificate = [&jobs](const Call& call, const RunControl& control) {
        return certificate_of(jobs, call, control);
    };
    router.add("GET", "/v1/jobs/{id}/controllers/{index}/certificate",
               as_file(synchronous(certificate, kCertificateTime, turns, timer, spare_cores, closing, no_body),
                       api::kCertificateMediaType, "certificate.jsonl"));
    router.add("POST", "/v1/plants/parse", parse_plant);
    add("/v1/evaluate", of_body(api::evaluate_call), kEvaluateTime);
    add("/v1/design", of_body(api::design_call), kDesignTime);
    add("/v1/frontier", of_body(api::frontier_call), kDesignTime);
    add("/v1/range", of_body(api::range_call), kRangeTime);
    add("/v1/cascade", of_body(api::cascade_call), kStructureTime);
    add("/v1/level", of_body(api::level_call), kStructureTime);
    add("/v1/feedforward", of_body(api::feedforward_call), kStructureTime);
    add("/v1/interaction", of_body(api::interaction_call), kStructureTime);
    add("/v1/predictor", of_body(api::predictor_call), kStructureTime);
    add("/v1/score", of_body(api::score_call), kScoreTime);
    add("/v1/verify", of_body(api::verify_call), kVerifyTime);
    add("/v1/check", of_body(api::check_call), kCheckTime);
    add("/v1/identify", of_body(api::identify_call), kIdentifyTime);
    add("/v1/records/controller", of_body(api::controller_record_call), kIdentifyTime);
    add("/v1/records/preview", preview, kIdentifyTime, refuse_file_call);
    add("/v1/experiments/relay", of_body(api::relay_call), kRelayTime);
    add("/v1/experiments/range", of_body(api::range_experiments_call), kRangeTime);
    add("/v1/controllers/{id}/settings", of_product(api::controller_settings_call), kConversionTime);
    add("/v1/controllers/{id}/schedule", of_product(api::controller_schedule_call), kConversionTime);
    add("/v1/controllers/{id}/controller", of_product(api::controller_twin_call), kConversionTime);
}

}  // namespace tunewright::server
