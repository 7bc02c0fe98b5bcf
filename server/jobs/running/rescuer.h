// Looks for jobs whose process has gone, and for batches that nobody goes on with. On a store that several processes
// use one of them does it at a time: whoever comes first when it is due.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <string>

#include "server/clock.h"
#include "server/jobs/store_outage_log.h"
#include "server/store/queue.h"

namespace tunewright::server {

struct RescuerSettings {
    std::chrono::milliseconds lease{10'000};
    std::chrono::milliseconds period{1000};  ///< how often it is due, all processes together
    bool shared = false;                     ///< else no other process has jobs
    int max_attempts = 10;
    std::string given_up;  ///< problem of a job that was interrupted that often
    std::function<UnixMs()> now;
    std::function<void()> clock_jumped;              ///< a sign of life is due before anybody is thought dead
    std::function<void(const Recovery&)> recovered;  ///< something was found
};

class Rescuer {
public:
    Rescuer(JobQueue& queue, StoreOutageLog& outage, RescuerSettings settings)
        : queue_(queue), outage_(outage), settings_(std::move(settings)) {}

    /// Not at the first call, nor where the wall clock has jumped since the last one: this machine slept, or its clock
    /// was set.
    void look();

private:
    JobQueue& queue_;
    StoreOutageLog& outage_;
    RescuerSettings settings_;
    std::atomic<bool> looking_ = false;
    WallDrift drift_;  ///< of the caller's thread alone
};

}  // namespace tunewright::server
