// Notes in the log when the store cannot be used any more and when it can be used again: one line each, however many
// calls fail.
#pragma once

#include <atomic>
#include <string_view>

#include "server/log.h"
#include "server/store/fault.h"

namespace tunewright::server {

/// Its functions may be called from any thread.
class Outage {
public:
    /// A call has failed while doing `what`.
    void failed(std::string_view what, const StoreFault& fault) {
        if (!down_.exchange(true)) log_error("the store cannot be used, " + std::string(what) + ": " + fault.detail);
    }
    /// A call has been done.
    void worked() {
        if (down_.load(std::memory_order_relaxed) && down_.exchange(false)) log_info("the store can be used again");
    }
    /// Whether the last call that was noted has failed.
    bool down() const { return down_; }

private:
    std::atomic<bool> down_ = false;
};

}  // namespace tunewright::server
