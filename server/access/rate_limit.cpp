#include "server/access/rate_limit.h"

#include <algorithm>

namespace tunewright::server {

RateLimit::RateLimit(double rate, double burst, std::size_t max_clients)
    : rate_(rate), burst_(std::max(burst, 1.0)), max_clients_(max_clients) {}

std::optional<std::chrono::duration<double>> RateLimit::refuse(const std::string& client, Time now) {
    const std::lock_guard lock(mutex_);
    const auto found = places_.find(client);
    if (found == places_.end()) {
        if (buckets_.size() >= max_clients_) {
            places_.erase(buckets_.back().client);
            buckets_.pop_back();
        }
        buckets_.push_front({client, burst_, now});
        places_.emplace(client, buckets_.begin());
    } else {
        buckets_.splice(buckets_.begin(), buckets_, found->second);
    }
    Bucket& bucket = buckets_.front();
    const double passed = std::max(0.0, std::chrono::duration<double>(now - bucket.filled).count());
    bucket.tokens = std::min(burst_, bucket.tokens + rate_ * passed);
    bucket.filled = now;
    if (bucket.tokens < 1) return std::chrono::duration<double>((1 - bucket.tokens) / rate_);
    bucket.tokens -= 1;
    return std::nullopt;
}

std::size_t RateLimit::clients() const {
    const std::lock_guard lock(mutex_);
    return buckets_.size();
}

}  // namespace tunewright::server
