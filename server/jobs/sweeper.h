// Deletes jobs that ended longer ago than the retention: thousands at a time while there are more, which the store
// divides into slices, so that nobody waits for them.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>

#include "server/store/store.h"

namespace tunewright::server {

class Sweeper {
public:
    Sweeper(JobStore& store, Retention retention, std::function<UnixMs()> now)
        : store_(store), retention_(retention), now_(std::move(now)) {}

    /// Sweeps a slice if one is due. Returns the time until the next call.
    std::chrono::milliseconds sweep();

private:
    using Clock = std::chrono::steady_clock;
    std::chrono::milliseconds before_first() const;
    bool clock_jumped(UnixMs now);
    void swept(std::size_t count);

    JobStore& store_;
    Retention retention_;
    std::function<UnixMs()> now_;
    std::optional<Clock::time_point> next_;  ///< this and the next member are used by the caller's thread only; empty
                                             ///< at the start
    WallDrift drift_;
    std::atomic<bool> sweeping_ = false;
    std::atomic<bool> more_ = false;
    std::atomic<std::chrono::milliseconds> pause_{};  ///< before the next slice, if there is more
    std::optional<std::size_t> first_ = 0;            ///< jobs deleted so far by the first sweep since the start
};

}  // namespace tunewright::server
