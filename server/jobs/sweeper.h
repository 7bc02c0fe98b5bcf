// Deletes jobs that ended longer ago than results are kept: a small slice at a time, so that nobody waits behind it.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>

#include "server/store/store.h"

namespace tunewright::server {

class Sweeper {
public:
    /// Without a retention nothing is ever deleted.
    Sweeper(JobStore& store, std::optional<std::chrono::seconds> retention, std::function<UnixMs()> now)
        : store_(store), retention_(retention), now_(std::move(now)) {}

    /// Sweeps a slice where one is due. Returns when to call it again.
    std::chrono::milliseconds sweep();

private:
    using Clock = std::chrono::steady_clock;
    JobStore& store_;
    std::optional<std::chrono::seconds> retention_;
    std::function<UnixMs()> now_;
    Clock::time_point next_{};  ///< of the caller's thread alone
    std::atomic<bool> sweeping_ = false;
    std::atomic<bool> more_ = false;
};

}  // namespace tunewright::server
