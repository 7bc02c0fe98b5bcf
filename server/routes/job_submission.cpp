#include "server/routes/job_submission.h"

#include <functional>
#include <string>
#include <utility>

#include "server/http/app/problems.h"
#include "server/jobs/await.h"
#include "server/routes/job_access.h"

namespace tunewright::server {

using http::problem_response;
using http::Response;

Response queue_full(const JobService& jobs, bool of_client) {
    const int seconds = jobs.seconds_until_room();
    api::Problem problem = http::problem(429, "The queue of jobs is full.");
    if (of_client) {
        problem.type = "too-many-jobs";
        problem.detail = "This client has " + std::to_string(jobs.client_jobs()) +
                         " jobs that wait or run, the limit of this service. Wait for the end of one, cancel one, or "
                         "post many as a batch.";
    }
    problem.detail += " Try again in " + std::to_string(seconds) + " s (Retry-After).";
    return problem_response(problem, std::chrono::seconds(seconds));
}

std::optional<Response> refuse_submission(const JobService& jobs, const Submission& submission) {
    switch (submission.kind) {
        case Submission::Kind::created:
        case Submission::Kind::existing: return std::nullopt;
        case Submission::Kind::conflict:
            return problem_response(409, "This Idempotency-Key was used before with another request. Use a new key.");
        case Submission::Kind::queue_full: return queue_full(jobs);
        case Submission::Kind::too_many: return queue_full(jobs, true);
        case Submission::Kind::draining:
            return problem_response(503, "The service is being stopped and accepts no more jobs. Try again shortly.");
        case Submission::Kind::store_failed: break;
    }
    return store_failed(submission.fault);
}

std::optional<Submitted> submit(JobService& jobs, Order order, const http::Request& call) {
    const bool waits = order.wait.count() > 0;
    const auto made = std::make_shared<Submitted>();
    const auto accept = [&](const std::function<void()>& wake) {
        const auto done = [made, waits, wake, keep = call.keep](Submission submission) {
            if (waits) std::string().swap(submission.job.request);
            made->submission = std::move(submission);
            if (keep) keep(0);
            if (!waits || made->submission.kind != Submission::Kind::created) wake();
        };
        jobs.submit(std::move(order), done, [made, wake](const std::shared_ptr<const JobRecord>& job) {
            made->ended = job;
            wake();
        });
    };
    if (!await_end(accept, waits ? call.left : nullptr)) return std::nullopt;
    return std::move(*made);
}

}  // namespace tunewright::server
