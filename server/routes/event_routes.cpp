#include <cstdint>
#include <list>
#include <memory>
#include <mutex>

#include <fmt/format.h>

#include "server/http/body/body_stream.h"
#include "server/http/negotiation.h"
#include "server/http/problems.h"
#include "server/routes/job_access.h"
#include "server/routes/job_json.h"
#include "server/routes/routes.h"

namespace tunewright::server {
namespace {

using http::BodyStream;
using http::Call;
using http::Reply;
using http::Response;

constexpr std::chrono::seconds kHeartbeat{15};
// A client that does not read gets no more progress until it does; the end always goes out.
constexpr std::size_t kSlow = 16 * 1024;
constexpr const char* kRetry = "retry: 2000\n\n";

/// Names one state of progress alike in every process: attempt and a sum of the text (FNV-1a, 64 bits).
std::string state_id(int attempts, std::string_view progress) {
    std::uint64_t sum = 14695981039346656037U;
    for (const char c : progress) sum = (sum ^ static_cast<unsigned char>(c)) * 1099511628211U;
    return fmt::format("{}-{:016x}", attempts, sum);
}

std::string event(std::string_view name, const std::string& id, const std::string& data) {
    std::string text = "event: ";
    text.append(name).append("\nid: ").append(id).append("\ndata: ").append(data).append("\n\n");
    return text;
}

/// One client that follows one job. Used by the followers' thread alone, once it is known to it.
class EventStream {
public:
    EventStream(std::shared_ptr<BodyStream> body, std::string known)
        : body_(std::move(body)), known_(std::move(known)) {}

    void send(const JobNews& news) {
        if (news.kind == JobNews::Kind::present) return tell_progress(*news.view);
        if (news.kind == JobNews::Kind::ended) body_->write(event("done", "done", job_news_json(*news.view)));
        body_->end();
    }

private:
    void tell_progress(const JobView& view) {
        const std::string progress = job_progress_json(view);
        std::string id = state_id(view.job.attempts, progress);
        if (id == known_ || body_->waiting() > kSlow) return;
        body_->write(event("progress", id, progress));
        known_ = std::move(id);
    }

    std::shared_ptr<BodyStream> body_;
    std::string known_;  ///< what the client has
};

/// A comment to each open stream now and then: proxies close connections on which nothing comes.
class Heartbeats : public std::enable_shared_from_this<Heartbeats> {
public:
    Heartbeats(JobService& jobs, Timer& timer) : jobs_(jobs), timer_(timer) {}

    void add(const std::shared_ptr<BodyStream>& body, Followers::Key follower) {
        const std::lock_guard lock(mutex_);
        streams_.push_back({body, follower});
        if (streams_.size() == 1) arm();
    }

private:
    void arm() {
        timer_.after(kHeartbeat, [weak = weak_from_this()] {
            if (const auto self = weak.lock()) self->beat();
        });
    }

    void beat() {
        const std::lock_guard lock(mutex_);
        streams_.remove_if([&](const Stream& stream) {
            const auto body = stream.body.lock();
            if (body && (body->waiting() > kSlow || body->write(": still here\n\n"))) return false;
            // A client that left before it had its answer notified nobody.
            jobs_.unfollow(stream.follower);
            return true;
        });
        if (!streams_.empty()) arm();
    }

    struct Stream {
        std::weak_ptr<BodyStream> body;
        Followers::Key follower;
    };
    JobService& jobs_;
    Timer& timer_;
    std::mutex mutex_;
    std::list<Stream> streams_;
};

/// What forbids to follow the job; 204 where the client has seen its end, which stops its trying again.
std::optional<Response> refuse_events(JobService& jobs, const Call& call) {
    if (!http::accepts(call.request, "text/event-stream"))
        return http::problem_response(406, "The answer is text/event-stream, which the Accept field does not allow.");
    const std::string& id = call.path.at("id");
    Response found = guarded([&] {
        const std::optional<JobState> state = jobs.state(id);
        return state && may_see(call.request, *state) ? Response() : no_such_job(id);
    });
    if (found.status != 200) return found;
    if (call.request.header("Last-Event-ID") != "done") return std::nullopt;
    found.status = 204;
    return found;
}

void follow_job(JobService& jobs, Heartbeats& heartbeats, const Call& call, const Reply& reply) {
    if (auto refusal = refuse_events(jobs, call)) return reply(*std::move(refusal));
    Response response;
    response.set("Content-Type", "text/event-stream");
    response.set("Cache-Control", "no-store");
    // nginx would gather events before it passes them on.
    response.set("X-Accel-Buffering", "no");
    if (call.request.method == "HEAD") return reply(std::move(response));

    const auto body = std::make_shared<BodyStream>();
    body->write(kRetry);
    const auto stream = std::make_shared<EventStream>(body, std::string(call.request.header("Last-Event-ID")));
    const Followers::Key key = jobs.follow(call.path.at("id"), [stream](const JobNews& news) { stream->send(news); });
    body->on_gone([&jobs, key] { jobs.unfollow(key); });
    heartbeats.add(body, key);
    response.stream = body;
    reply(std::move(response));
}

}  // namespace

void add_event_routes(http::Router& router, JobService& jobs, Timer& timer) {
    const auto heartbeats = std::make_shared<Heartbeats>(jobs, timer);
    router.deferred("GET", "/v1/jobs/{id}/events", [&jobs, heartbeats](const Call& call, const Reply& reply) {
        follow_job(jobs, *heartbeats, call, reply);
    });
}

}  // namespace tunewright::server
