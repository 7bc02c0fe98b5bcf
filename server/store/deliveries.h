// Notes of ended jobs and batches that are on their way to whoever asked for one. A note is written in the transaction
// that ends its job, so none is lost; it may be delivered twice, never not at all while its time lasts.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/clock.h"
#include "server/store/fault.h"

namespace tunewright::server {

/// Whom to tell when a job or a batch has ended; `url` "" for nobody.
struct NotifyTarget {
    std::string url;
    std::string secret_id;  ///< names the operator's secret that signs it; "" for the first

    /// As stores keep it: "" for nobody.
    std::string text() const { return url.empty() ? std::string{} : secret_id + " " + url; }
    static NotifyTarget of_text(const std::string& text) {
        const std::size_t blank = text.find(' ');
        return {text.substr(blank + 1), text.substr(0, blank)};
    }
};

struct Delivery {
    std::int64_t seq = 0;
    NotifyTarget target;
    std::string job;    ///< its id; "" where a batch has ended
    std::string batch;  ///< likewise
    int tries = 0;      ///< that failed so far
    UnixMs created_at = 0;
};

class DeliveryStore {
public:
    virtual ~DeliveryStore() = default;

    /// Those that are due, the oldest first; they are nobody else's for `hold` from now.
    virtual void take_deliveries(UnixMs now, std::chrono::milliseconds hold, std::size_t max,
                                 Done<std::vector<Delivery>> done) = 0;
    /// Delivered or given up: it goes. With a pause: the next try is due so long after `now`; one that was `tried` has
    /// failed once more, another was not for this process to send.
    virtual void settle_delivery(std::int64_t seq, UnixMs now, std::optional<std::chrono::milliseconds> pause,
                                 bool tried, Done<bool> done) = 0;
};

}  // namespace tunewright::server
