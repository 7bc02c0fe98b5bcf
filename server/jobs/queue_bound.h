// How many jobs wait, so that the queue stays bounded: counted here as they come and go, put right by the store, which
// other processes may use too.
#pragma once

#include <cstdint>
#include <mutex>

#include "server/store/queue.h"

namespace tunewright::server {

class QueueBound {
public:
    QueueBound(std::size_t single_limit, std::size_t entry_limit)
        : single_limit_(single_limit), entry_limit_(entry_limit) {}

    /// Takes a place for a single job that is being accepted; false where there is none. Then one of the next two.
    bool reserve();
    void accepted();
    void refused();
    /// So many wait no longer.
    void gone(std::size_t singles, std::size_t entries = 0);
    /// Counts so many entries as waiting where there is room for them; else changes nothing.
    bool reserve_entries(std::size_t count);
    /// So it is now, whatever the store said when it was last asked.
    void paused(bool paused);
    /// Asks the store. Throws StoreError.
    void refresh(JobQueue& queue);

    QueueDepth now() const;

private:
    std::size_t single_limit_;
    std::size_t entry_limit_;
    mutable std::mutex mutex_;
    std::size_t accepting_ = 0;
    QueueDepth waiting_;
    std::uint64_t changes_ = 0;
};

}  // namespace tunewright::server
