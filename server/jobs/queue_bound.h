// How many jobs wait, so that the queue stays bounded: counted here as they come and go, put right by the store, which
// other processes may use too.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <utility>

#include "server/store/queue.h"

namespace tunewright::server {

class QueueBound {
public:
    QueueBound(std::size_t single_limit, std::size_t entry_limit)
        : single_limit_(single_limit), entry_limit_(entry_limit) {}

    /// A single job that is being accepted: counted until it waits, is refused, or nobody holds its place any more.
    class Place {
    public:
        explicit Place(QueueBound& bound) : bound_(&bound) {}
        ~Place() { end(false); }
        Place(const Place&) = delete;
        Place& operator=(const Place&) = delete;
        void end(bool waits) {
            if (QueueBound* bound = std::exchange(bound_, nullptr)) bound->decided(waits);
        }

    private:
        QueueBound* bound_;
    };
    /// Nothing where there is no room.
    std::shared_ptr<Place> reserve();
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
    void decided(bool waits);

    std::size_t single_limit_;
    std::size_t entry_limit_;
    mutable std::mutex mutex_;
    std::size_t accepting_ = 0;
    QueueDepth waiting_;
    std::uint64_t changes_ = 0;
};

}  // namespace tunewright::server
