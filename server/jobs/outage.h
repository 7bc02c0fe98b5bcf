// Tells the log of a store that cannot be used once at its begin and once at its end, however many calls failed.
#pragma once

#include <atomic>
#include <string_view>

#include "server/log.h"
#include "server/store/store.h"

namespace tunewright::server {

class Outage {
public:
    void failed(std::string_view what, const StoreFault& fault) {
        if (!down_.exchange(true)) log_error("the store cannot be used, " + std::string(what) + ": " + fault.detail);
    }
    void worked() {
        if (down_.load(std::memory_order_relaxed) && down_.exchange(false)) log_info("the store can be used again");
    }
    bool down() const { return down_; }

private:
    std::atomic<bool> down_ = false;
};

}  // namespace tunewright::server
