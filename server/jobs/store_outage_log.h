// Logs the beginning and the end of a store outage: one line each, however many calls fail, even if some succeed in
// between, as on a full disk.
#pragma once

#include <atomic>
#include <chrono>
#include <string_view>

#include "server/log.h"
#include "server/store/fault.h"

namespace tunewright::server {

/// Its functions may be called from any thread.
class StoreOutageLog {
public:
    /// A call failed during `what`.
    void failed(std::string_view what, const StoreFault& fault) {
        failed_at_ = Clock::now();
        if (!down_.exchange(true)) log_error("the store cannot be used, " + std::string(what) + ": " + fault.detail);
    }
    /// A call succeeded.
    void worked() {
        if (!down_.load(std::memory_order_relaxed) || Clock::now() - failed_at_.load() < kMinQuietTime) return;
        if (down_.exchange(false)) log_info("the store can be used again");
    }

private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds kMinQuietTime{5};

    std::atomic<bool> down_ = false;
    std::atomic<Clock::time_point> failed_at_{};
};

}  // namespace tunewright::server
