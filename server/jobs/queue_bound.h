// The number of waiting jobs, which bounds the queue: counted here, and corrected by the store, which other processes
// may use too.
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

    /// A single job that is being accepted: counted until it waits, is refused, or its last Place is destroyed.
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
    /// Empty if there is no room.
    std::shared_ptr<Place> reserve();
    /// These numbers of jobs no longer wait.
    void gone(std::size_t singles, std::size_t entries = 0);
    /// Counts these entries as waiting if there is room for them; otherwise changes nothing.
    bool reserve_entries(std::size_t count);
    /// Sets the current state, which replaces the store's last answer.
    void paused(bool paused);
    /// Reads the numbers from the store. Throws StoreError.
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
