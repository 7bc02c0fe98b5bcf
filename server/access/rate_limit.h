// How often each client may call: a bucket of tokens that fills at a steady rate.
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

    /// `rate` calls a second, and at once `burst` of them after a pause; both > 0. At most `max_clients` are
    /// remembered; the one that has been quiet for longest is forgotten first.
    explicit RateLimit(double rate, double burst, std::size_t max_clients = 100'000);

    /// Takes a token of the client's. Where there is none: after how long there will be one.
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
    std::list<Bucket> buckets_;  ///< who called last is in front
    std::unordered_map<std::string, std::list<Bucket>::iterator> places_;
};

}  // namespace tunewright::server
