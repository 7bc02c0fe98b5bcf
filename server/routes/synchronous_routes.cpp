#include <algorithm>
#include <memory>
#include <mutex>
#include <stop_token>

#include <fmt/format.h>

#include "api/service.h"
#include "server/http/problems.h"
#include "server/routes/request_checks.h"
#include "server/routes/routes.h"

namespace tunewright::server {
namespace {

using http::Call;
using http::problem_response;
using http::Response;
using SyncCall = api::Answer (*)(std::string_view, const RunControl&);

constexpr std::chrono::seconds kEvaluateTime{10};
constexpr std::chrono::seconds kIdentifyTime{30};
constexpr std::chrono::seconds kRelayTime{10};
constexpr std::chrono::milliseconds kLook{250};  // for clients that have gone

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

/// Stops a computation at its deadline, when the service stops, or when nobody waits for it any more.
class Overseer : public std::enable_shared_from_this<Overseer> {
public:
    Overseer(Timer& timer, Turns::Clock::time_point deadline, std::function<bool()> left)
        : timer_(timer), deadline_(deadline), left_(std::move(left)) {}

    void look() {
        const std::lock_guard lock(mutex_);
        if (over_) return;
        if (Turns::Clock::now() >= deadline_ || (left_ && left_())) return stop();
        const std::chrono::duration<double> rest = deadline_ - Turns::Clock::now();
        timer_.after(std::min<std::chrono::duration<double>>(kLook, rest),
                     [self = shared_from_this()] { self->look(); });
    }
    void stop() { stop_.request_stop(); }
    /// From now on the client is not looked at.
    void end() {
        const std::lock_guard lock(mutex_);
        over_ = true;
    }
    std::stop_token token() const { return stop_.get_token(); }

private:
    Timer& timer_;
    const Turns::Clock::time_point deadline_;
    const std::function<bool()> left_;
    std::stop_source stop_;
    std::mutex mutex_;
    bool over_ = false;
};

/// The answer of `work`, which runs on this thread. Its turn has come.
Response compute(SyncCall work, const http::Request& request, std::chrono::seconds limit,
                 const std::shared_ptr<Overseer>& overseer, const std::stop_token& closing) {
    const std::stop_callback on_closing(closing, [overseer] { overseer->stop(); });
    RunControl control;
    control.stop = overseer->token();
    control.now_ms = monotonic_ms;
    const double start = monotonic_ms();
    const api::Answer answer = work(request.body, control);
    if (answer.status >= 400 && closing.stop_requested()) return closing_down();
    if (answer.status >= 400 && control.stop.stop_requested()) return too_slow(limit);

    Response response;
    response.status = answer.status;
    response.body = answer.body;
    response.set("Content-Type", answer.status >= 400 ? "application/problem+json" : "application/json");
    return response.set("Server-Timing", fmt::format("compute;dur={:.2f}", monotonic_ms() - start));
}

/// The time counts from the arrival of the request, waiting for its turn included.
http::Handler synchronous(SyncCall work, std::chrono::seconds limit, Turns& turns, Timer& timer,
                          const std::stop_token& closing) {
    return [=, &turns, &timer](const Call& call) {
        const auto deadline = Turns::Clock::now() + limit;
        if (auto refusal = refuse_call(call.request)) return *std::move(refusal);
        if (closing.stop_requested()) return closing_down();
        switch (turns.take(call.request.client, deadline, call.request.left)) {
            case Turns::Wait::full:
                return problem_response(429, "Too many computations are waiting. Try again after a moment.");
            case Turns::Wait::late: return too_slow(limit);
            case Turns::Wait::left: return Response();
            case Turns::Wait::granted: break;
        }
        const auto overseer = std::make_shared<Overseer>(timer, deadline, call.request.left);
        overseer->look();
        const std::shared_ptr<void> ended(nullptr, [&](void*) {
            overseer->end();
            turns.give_back();
        });
        return compute(work, call.request, limit, overseer, closing);
    };
}

}  // namespace

void add_synchronous_routes(http::Router& router, Turns& turns, Timer& timer, const std::stop_token& closing) {
    router.add("POST", "/v1/evaluate", synchronous(api::evaluate_call, kEvaluateTime, turns, timer, closing));
    router.add("POST", "/v1/identify", synchronous(api::identify_call, kIdentifyTime, turns, timer, closing));
    router.add("POST", "/v1/experiments/relay", synchronous(api::relay_call, kRelayTime, turns, timer, closing));
}

}  // namespace tunewright::server
