#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "server/http/app/negotiation.h"
#include "server/http/app/problems.h"
#include "server/routes/job_access.h"
#include "server/routes/job_json.h"
#include "server/routes/routes.h"

namespace tunewright::server {
namespace {

using http::Call;
using http::Response;

constexpr std::chrono::milliseconds kPollInterval{1000};  // between checks for clients that have disconnected
constexpr int kHeartbeat = 15;                            // poll intervals
constexpr const char* kRetry = "retry: 2000\n\n";

/// Identifies a state of progress, in the same way in every process: attempt and a checksum of the text.
std::string state_id(int attempts, std::string_view progress) {
    return fmt::format("{}-{}", attempts, http::text_sum(progress));
}

std::string event(std::string_view name, const std::string& id, const std::string& data) {
    std::string text = "event: ";
    text.append(name).append("\nid: ").append(id).append("\ndata: ").append(data).append("\n\n");
    return text;
}

/// Events for one client, until its thread has sent them. Only the latest progress is kept, so that a slow client gets
/// fewer events; the end is always sent.
class News {
public:
    void put(const JobNews& news) {
        const std::lock_guard lock(mutex_);
        if (latest_ && latest_->kind != JobNews::Kind::present) return;
        latest_ = news;
        come_.notify_one();
    }
    /// Empty if none has arrived within `patience`.
    std::optional<JobNews> wait(std::chrono::milliseconds patience) {
        std::unique_lock lock(mutex_);
        come_.wait_for(lock, patience, [this] { return latest_.has_value(); });
        return std::exchange(latest_, std::nullopt);
    }

private:
    std::mutex mutex_;
    std::condition_variable come_;
    std::optional<JobNews> latest_;
};

/// One client that follows one job, while it is connected.
class EventStream {
public:
    EventStream(JobService& jobs, std::string job, std::string known, std::function<bool()> admitted)
        : jobs_(jobs), job_(std::move(job)), known_(std::move(known)), admitted_(std::move(admitted)) {}

    void send(http::BodyWriter& out) {
        const auto news = std::make_shared<News>();
        const Followers::Key key = jobs_.follow(job_, [news](const JobNews& item) { news->put(item); });
        out.write(kRetry);
        for (int silent = 0; goes_on(out, news->wait(kPollInterval), silent);) {
        }
        jobs_.unfollow(key);
    }

private:
    bool goes_on(http::BodyWriter& out, const std::optional<JobNews>& news, int& silent) {
        if (out.gone() || !is_admitted()) return false;
        silent = news ? 0 : silent + 1;
        // Proxies close idle connections.
        if (!news) return silent % kHeartbeat != 0 || out.write(": still here\n\n");
        if (news->kind == JobNews::Kind::present) return send_progress(out, *news->view);
        if (news->kind == JobNews::Kind::ended) out.write(event("done", "done", job_news_json(*news->view)));
        return false;
    }

    /// Checked once a second: a key may be removed while its owner follows.
    bool is_admitted() {
        const auto now = std::chrono::steady_clock::now();
        if (!admitted_ || now - asked_ < kPollInterval) return true;
        asked_ = now;
        return admitted_();
    }

    bool send_progress(http::BodyWriter& out, const JobView& view) {
        const std::string progress = job_progress_json(view);
        std::string id = state_id(view.job.attempts, progress);
        if (id == known_) return true;
        const bool sent = out.write(event("progress", id, progress));
        known_ = std::move(id);
        return sent;
    }

    JobService& jobs_;
    std::string job_;
    std::string known_;  ///< the state that the client has
    std::function<bool()> admitted_;
    std::chrono::steady_clock::time_point asked_ = std::chrono::steady_clock::now();
};

/// The refusal if the job cannot be followed; 204 if the client has seen its end, so that it stops reconnecting.
std::optional<Response> refuse_events(JobService& jobs, const Call& call) {
    if (!http::accepts(call.request, "text/event-stream"))
        return http::problem_response(406, "The answer is text/event-stream, which the Accept field does not allow.");
    const std::string& id = call.path.at("id");
    Response found = guarded([&] {
        const std::optional<JobState> state = jobs.state(id);
        if (!state || !may_see(call.request, *state)) return no_such_job(id);
        Response answer;
        // A job that was queued again since then has another end to come.
        if (call.request.header("Last-Event-ID") == "done" && has_ended(state->status)) answer.status = 204;
        return answer;
    });
    if (found.status == 200) return std::nullopt;
    return found;
}

Response follow_job(JobService& jobs, LongRequestSlots& places, const Call& call) {
    if (auto refusal = refuse_events(jobs, call)) return *std::move(refusal);
    const auto place = std::make_shared<std::optional<LongRequestSlots::Slot>>(places.take(call.request.client));
    if (!*place) return http::problem_response(503, "Too many clients follow jobs or wait for them. Ask for the job.");
    Response response;
    response.set("Content-Type", "text/event-stream");
    response.set("Cache-Control", "no-store");
    // nginx would otherwise buffer events.
    response.set("X-Accel-Buffering", "no");
    response.stream = [&jobs, place, id = call.path.at("id"), known = std::string(call.request.header("Last-Event-ID")),
                       admitted = call.request.admitted](http::BodyWriter& out) {
        EventStream(jobs, id, known, admitted).send(out);
        return true;
    };
    return response;
}

}  // namespace

void add_event_routes(http::Router& router, JobService& jobs, LongRequestSlots& places) {
    router.quick("GET", "/v1/jobs/{id}/events",
                 [&jobs, &places](const Call& call) { return follow_job(jobs, places, call); });
}

}  // namespace tunewright::server
