// Deletes jobs that ended longer ago than results are kept: thousands at a time while there are more, which the store
// parts into slices, so that nobody waits behind them.
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

    /// Sweeps a slice where one is due. Returns when to call it again.
    std::chrono::milliseconds sweep();

private:
    using Clock = std::chrono::steady_clock;
    std::chrono::milliseconds before_first() const;
    bool clock_jumped(UnixMs now);
    void swept(std::size_t count);

    JobStore& store_;
    Retention retention_;
    std::function<UnixMs()> now_;
    std::optional<Clock::time_point> next_;  ///< this and the next of the caller's thread alone; nothing at the start
    WallDrift drift_;
    std::atomic<bool> sweeping_ = false;
    std::atomic<bool> more_ = false;
    std::atomic<std::chrono::milliseconds> pause_{};  ///< before the next slice, where there is more
    std::optional<std::size_t> first_ = 0;            ///< jobs gone so far with the first sweep since the start
};

}  // namespace tunewright::server
