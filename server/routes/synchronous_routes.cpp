#include <atomic>
#include <memory>
#include <stop_token>

#include <fmt/format.h>

#include "api/service.h"
#include "server/http/problems.h"
#include "server/log.h"
#include "server/routes/request_checks.h"
#include "server/routes/routes.h"

namespace tunewright::server {
namespace {

using http::Call;
using http::problem_response;
using http::Reply;
using http::Response;
using SyncCall = api::Answer (*)(std::string_view, const RunControl&);

constexpr std::size_t kMaxWaiting = 64;
constexpr std::chrono::seconds kEvaluateTime{10};
constexpr std::chrono::seconds kIdentifyTime{30};
constexpr std::chrono::seconds kRelayTime{10};

double monotonic_ms() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Response too_slow(std::chrono::seconds limit) {
    Error error;
    error.kind = ErrorKind::timeout;
    error.message = "The computation was stopped after " + std::to_string(limit.count()) +
                    " s. Ask for less, or post it as a job, which may take longer.";
    return http::problem_response(api::to_problem(error));
}

Response closing_down() { return problem_response(503, "The service is being stopped. Try again shortly."); }

Response compute(SyncCall work, const std::string& body, std::chrono::seconds limit, Timer& timer,
                 const std::stop_token& closing) {
    const auto stop = std::make_shared<std::stop_source>();
    const std::stop_callback on_closing(closing, [stop] { stop->request_stop(); });
    const Timer::Key deadline = timer.after(limit, [stop] { stop->request_stop(); });
    RunControl control;
    control.stop = stop->get_token();
    control.now_ms = monotonic_ms;
    const double start = monotonic_ms();
    api::Answer answer;
    try {
        answer = work(body, control);
    } catch (const std::exception& fault) {
        log_error(std::string("a synchronous call failed: ") + fault.what());
        answer.status = 500;
    }
    timer.cancel(deadline);
    if (answer.status == 500)
        return problem_response(500, "The computation met a fault of the service; its log says more.");
    if (answer.status >= 400 && closing.stop_requested()) return closing_down();
    if (answer.status >= 400 && stop->stop_requested()) return too_slow(limit);

    Response response;
    response.status = answer.status;
    response.body = std::move(answer.body);
    response.set("Content-Type", answer.status >= 400 ? "application/problem+json" : "application/json");
    return response.set("Server-Timing", fmt::format("compute;dur={:.2f}", monotonic_ms() - start));
}

http::AsyncHandler synchronous(SyncCall work, std::chrono::seconds limit, Executor& lane, Timer& timer,
                               const std::stop_token& closing) {
    return [=, &lane, &timer](Call call, const Reply& reply) {
        if (auto refusal = refuse_call(call.request)) return reply(*std::move(refusal));
        if (closing.stop_requested()) return reply(closing_down());
        const bool taken = lane.post_within(kMaxWaiting, [=, body = std::move(call.request.body), &timer] {
            reply(compute(work, body, limit, timer, closing));
        });
        if (!taken) reply(problem_response(429, "Too many computations are waiting. Try again after a moment."));
    };
}

}  // namespace

void add_synchronous_routes(http::Router& router, Executor& lane, Timer& timer, const std::stop_token& closing) {
    router.deferred("POST", "/v1/evaluate", synchronous(api::evaluate_call, kEvaluateTime, lane, timer, closing));
    router.deferred("POST", "/v1/identify", synchronous(api::identify_call, kIdentifyTime, lane, timer, closing));
    router.deferred("POST", "/v1/experiments/relay", synchronous(api::relay_call, kRelayTime, lane, timer, closing));
}

}  // namespace tunewright::server
