#include "server/jobs/queue_bound.h"

#include <algorithm>

namespace tunewright::server {
namespace {

constexpr int kTries = 3;

void take(std::size_t& from, std::size_t count) { from -= std::min(from, count); }

}  // namespace

std::shared_ptr<QueueBound::Place> QueueBound::reserve() {
    {
        const std::lock_guard lock(mutex_);
        if (waiting_.single + accepting_ >= single_limit_) return nullptr;
        accepting_++;
    }
    return std::shared_ptr<Place>(new Place(*this));
}

void QueueBound::decided(bool waits) {
    const std::lock_guard lock(mutex_);
    accepting_--;
    if (!waits) return;
    waiting_.single++;
    changes_++;
}

void QueueBound::gone(std::size_t singles, std::size_t entries) {
    const std::lock_guard lock(mutex_);
    take(waiting_.single, singles);
    take(waiting_.entries, entries);
    changes_++;
}

bool QueueBound::reserve_entries(std::size_t count) {
    const std::lock_guard lock(mutex_);
    if (waiting_.entries + count > entry_limit_) return false;
    waiting_.entries += count;
    changes_++;
    return true;
}

void QueueBound::paused(bool paused) {
    const std::lock_guard lock(mutex_);
    waiting_.paused = paused;
    changes_++;
}

void QueueBound::refresh(JobQueue& queue) {
    for (int i = 0; i < kTries; i++) {
        std::uint64_t before = 0;
        {
            const std::lock_guard lock(mutex_);
            before = changes_;
        }
        const QueueDepth counted = queue.depth();
        const std::lock_guard lock(mutex_);
        // Changes during the store's count may be counted twice or not at all; the last attempt accepts that.
        if (changes_ != before && i + 1 < kTries) continue;
        waiting_ = counted;
        return;
    }
}

QueueDepth QueueBound::now() const {
    const std::lock_guard lock(mutex_);
    QueueDepth now = waiting_;
    now.single += accepting_;
    if (waiting_.single == 0) now.next_single.reset();
    if (waiting_.entries == 0) now.next_entry.reset();
    return now;
}

}  // namespace tunewright::server
