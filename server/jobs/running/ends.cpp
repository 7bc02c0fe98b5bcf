#include "server/jobs/running/ends.h"

namespace tunewright::server {
namespace {

std::size_t size_of(const Ended& ended) { return ended.end.result.size() + ended.end.error.size(); }

}  // namespace

Ends::Ends(JobStore& store, Outage& outage, Listener listener)
    : store_(store), outage_(outage), listener_(std::move(listener)) {}

void Ends::finish(Ended ended) {
    ended.held->enter(HeldJob::Stage::ending);
    const auto kept = std::make_shared<const Ended>(std::move(ended));
    count(size_of(*kept), 0);
    offer(kept);
}

void Ends::offer(const std::shared_ptr<const Ended>& ended) {
    store_.finish(ended->end, [this, ended](const Outcome<bool>& outcome) {
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

void Ends::release(const std::shared_ptr<HeldJob>& held) {
    store_.release(held->job.id, held->job.attempts, [this, held](const Outcome<bool>& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome))
            outage_.failed("a job cannot be queued again", *fault);
        listener_.released(held);
    });
}

void Ends::retry() {
    std::vector<std::shared_ptr<const Ended>> refused;
    {
        const std::lock_guard lock(mutex_);
        refused.swap(refused_);
    }
    for (const auto& ended : refused) offer(ended);
}

void Ends::count(std::size_t more, std::size_t less) {
    std::size_t bytes = 0;
    {
        const std::lock_guard lock(mutex_);
        bytes = bytes_ += more - less;
    }
    listener_.unsaved(bytes);
}

}  // namespace tunewright::server
