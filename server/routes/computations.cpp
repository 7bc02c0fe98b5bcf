#include "server/routes/computations.h"

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <string>

#include <fmt/format.h>

#include "server/clock.h"
#include "server/http/app/problems.h"
#include "server/routes/request_checks.h"

namespace tunewright::server {
namespace {

using http::problem_response;
using http::Response;
using Work = std::function<api::Answer(const RunControl&)>;

constexpr std::chrono::milliseconds kGonePollInterval{250};  // between checks for clients that have disconnected

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
Response compute(const Work& work, std::chrono::seconds limit, SpareCores& spare_cores,
                 const std::shared_ptr<ComputationWatchdog>& watchdog, const std::stop_token& closing) {
    const std::stop_callback on_closing(closing, [watchdog] { watchdog->stop(); });
    RunControl control;
    control.stop = watchdog->token();
    control.now_ms = monotonic_ms;
    SpareCores::Computation computation(spare_cores);
    control.spread = computation.spread();
    const double start = monotonic_ms();
    api::Answer answer = work(control);
    if (answer.status >= 400 && closing.stop_requested()) return closing_down();
    if (answer.status >= 400 && watchdog->gone()) return client_gone();
    if (answer.status >= 400 && control.stop.stop_requested()) return too_slow(limit);

    Response response = response_of(std::move(answer));
    response.set("Server-Timing", fmt::format("compute;dur={:.2f}", monotonic_ms() - start));
    return response;
}

}  // namespace

Response Computations::answer(const http::Request& request, std::chrono::seconds limit, const Work& work) const {
    const auto deadline = ComputeSlots::Clock::now() + limit;
    if (closing_.stop_requested()) return closing_down();
    switch (turns_.take(request.client, deadline, request.left)) {
        case ComputeSlots::Wait::full:
            return problem_response(429, "Too many computations are waiting. Try again after a moment.");
        case ComputeSlots::Wait::late: return too_busy(limit);
        case ComputeSlots::Wait::left: return client_gone();
        case ComputeSlots::Wait::granted: break;
    }
    const auto watchdog = std::make_shared<ComputationWatchdog>(timer_, deadline, request.left);
    watchdog->look_later();
    const std::shared_ptr<void> ended(nullptr, [&](void*) {
        watchdog->end();
        turns_.give_back(request.client);
    });
    return compute(work, limit, spare_cores_, watchdog, closing_);
}

}  // namespace tunewright::server
