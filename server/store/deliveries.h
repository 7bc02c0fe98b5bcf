// Pending notifications of ended jobs and batches. A notification is written in the transaction that ends its job, so
// none is lost; it may be delivered twice, but at least once unless all attempts fail.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/clock.h"
#include "server/store/fault.h"

namespace tunewright::server {

/// Target of a notification when a job or a batch has ended; `url` "" for none.
struct NotifyTarget {
    std::string url;
    std::string secret_id;  ///< names the operator's secret that signs it; "" for the first

    /// The stored form: "" for no target.
    std::string text() const { return url.empty() ? std::string{} : secret_id + " " + url; }
    static NotifyTarget of_text(const std::string& text) {
        const std::size_t blank = text.find(' ');
        return {text.substr(blank + 1), text.substr(0, blank)};
    }
};

struct Delivery {
    std::int64_t seq = 0;
    NotifyTarget target;
    std::string job;    ///< its id; "" if a batch has ended
    std::string batch;  ///< its id; "" if a single job has ended
    int tries = 0;      ///< failed attempts so far
    UnixMs created_at = 0;
};

class DeliveryStore {
public:
    virtual ~DeliveryStore() = default;

    /// Takes those that are due, the oldest first, and reserves them for `hold` from now on.
    virtual void take_deliveries(UnixMs now, std::chrono::milliseconds hold, std::size_t max,
                                 Done<std::vector<Delivery>> done) = 0;
    /// Without a pause it was delivered or given up, and is deleted. With a pause: the next attempt is due that long
    /// after `now`; `tried`: one more attempt has failed; otherwise this process was not allowed to send it.
    virtual void settle_delivery(std::int64_t seq, UnixMs now, std::optional<std::chrono::milliseconds> pause,
                                 bool tried, Done<bool> done) = 0;
};

}  // namespace tunewright::server
