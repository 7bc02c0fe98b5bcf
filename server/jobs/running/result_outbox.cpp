#include "server/jobs/running/result_outbox.h"

#include "api/json/problem.h"
#include "engine/error.h"
#include "engine/number_text.h"

namespace tunewright::server {
namespace {

std::size_t size_of(const Ended& ended) { return ended.end.result.size() + ended.end.error.size(); }

}  // namespace

ResultOutbox::ResultOutbox(JobQueue& queue, StoreOutageLog& outage, Listener listener)
    : queue_(queue), outage_(outage), listener_(std::move(listener)) {}

void ResultOutbox::finish(Ended ended) {
    ended.held->enter(HeldJob::Stage::ending);
    const auto kept = std::make_shared<const Ended>(std::move(ended));
    count(size_of(*kept), 0);
    offer(kept);
}

void ResultOutbox::offer(const std::shared_ptr<const Ended>& ended) {
    queue_.finish(ended->end, [this, ended](const Outcome<bool>& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) {
            outage_.failed("a result is kept in memory", *fault);
            const std::lock_guard lock(mutex_);
            refused_.push_back(ended);
            return;
        }
        outage_.worked();
        listener_.done(*ended, std::get<bool>(outcome));
        count(0, size_of(*ended));
    });
}

void ResultOutbox::release(const std::shared_ptr<HeldJob>& held) {
    queue_.release(held->job.seq, held->job.attempts, [this, held](const Outcome<bool>& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome))
            outage_.failed("a job cannot be queued again", *fault);
        listener_.released(held);
    });
}

void ResultOutbox::retry() {
    std::vector<std::shared_ptr<const Ended>> refused;
    {
        const std::lock_guard lock(mutex_);
        refused.swap(refused_);
    }
    for (const auto& ended : refused) offer(ended);
}

void ResultOutbox::count(std::size_t more, std::size_t less) {
    std::size_t bytes = 0;
    {
        const std::lock_guard lock(mutex_);
        bytes = bytes_ += more - less;
    }
    listener_.unsaved(bytes);
}

std::string timeout_problem(double timeout_s) {
    Error error;
    error.kind = ErrorKind::timeout;
    error.where = "timeout_s";
    error.message = "The job was stopped after timeout_s = " + text(timeout_s, 6) +
                    " s. Use fewer methods or a simpler search, or raise timeout_s.";
    return api::to_json(api::to_problem(error));
}

std::string given_up_problem(int attempts) {
    return fault_problem("The job was interrupted " + std::to_string(attempts) +
                         " times because the process that computed it ended, and is not tried again. If other jobs "
                         "succeed, this one may be the cause: use a simpler search. Otherwise post it again.");
}

std::string fault_problem(const std::string& detail) {
    api::Problem problem;
    problem.status = 500;
    problem.type = "internal";
    problem.title = "Internal Server Error";
    problem.detail = detail;
    return api::to_json(problem);
}

}  // namespace tunewright::server
