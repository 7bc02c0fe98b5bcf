// Limits the rate of calls of each client: a bucket of tokens that fills at a steady rate.
#pragma once

#include <chrono>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <unordered_map>

namespace tunewright::server {

class RateLimit {
public:
    using Time = std::chrono::steady_clock::time_point;

    /// `rate` calls per second, and `burst` of them at once after a pause; both > 0. At most `max_clients` are
    /// remembered; the one with the oldest last call is forgotten first.
    explicit RateLimit(double rate, double burst, std::size_t max_clients = 100'000);

    /// Takes a token of the client. If there is none: the time until the next one.
    std::optional<std::chrono::duration<double>> refuse(const std::string& client, Time now);

    std::size_t clients() const;

private:
    struct Bucket {
        std::string client;
        double tokens = 0;
        Time filled{};
    };

    double rate_;
    double burst_;
    std::size_t max_clients_;
    mutable std::mutex mutex_;
    std::list<Bucket> buckets_;  ///< the client with the latest call comes first
    std::unordered_map<std::string, std::list<Bucket>::iterator> places_;
};

}  // namespace tunewright::server
