// Notes in the log when the store cannot be used any more and when it can be used again: one line each, however many
// calls fail, and though some work in between, as they do on a full disk.
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
    /// A call has failed while doing `what`.
    void failed(std::string_view what, const StoreFault& fault) {
        failed_at_ = Clock::now();
        if (!down_.exchange(true)) log_error("the store cannot be used, " + std::string(what) + ": " + fault.detail);
    }
    /// A call has been done.
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
