// Finds jobs whose process has ended, and batches that nobody continues. In a shared store one process does it at a
// time: the first when it is due.
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
    std::chrono::milliseconds period{1000};  ///< the interval, over all processes
    bool shared = false;                     ///< false: no other process has jobs
    int max_attempts = 10;
    std::string given_up;  ///< problem of a job that was interrupted too often
    std::function<UnixMs()> now;
    std::function<void()> clock_jumped;              ///< called before any other process is considered dead, so that it
                                                     ///< can send a heartbeat first
    std::function<void(const Recovery&)> recovered;  ///< called if something was found
};

class Rescuer {
public:
    Rescuer(JobQueue& queue, StoreOutageLog& outage, RescuerSettings settings)
        : queue_(queue), outage_(outage), settings_(std::move(settings)) {}

    /// Does nothing at the first call, or if the wall clock has jumped since the last one: this machine slept, or its
    /// clock was set.
    void look();

private:
    JobQueue& queue_;
    StoreOutageLog& outage_;
    RescuerSettings settings_;
    std::atomic<bool> looking_ = false;
    WallDrift drift_;  ///< used by the caller's thread only
};

}  // namespace tunewright::server
