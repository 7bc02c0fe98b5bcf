// Calls that compute while their client waits: in turn, within a time limit, as long as somebody waits.
#pragma once

#include <chrono>
#include <functional>
#include <stop_token>
#include <utility>

#include "api/outcome.h"
#include "engine/progress.h"
#include "server/access/compute_slots.h"
#include "server/http/message.h"
#include "server/threads/spare_cores.h"
#include "server/threads/timer.h"

namespace tunewright::server {

/// The shared means of these calls, which must outlive it. Cheap to copy.
class Computations {
public:
    Computations(ComputeSlots& turns, Timer& timer, SpareCores& spare_cores, std::stop_token closing)
        : turns_(turns), timer_(timer), spare_cores_(spare_cores), closing_(std::move(closing)) {}

    /// The answer of `work`, which runs on this thread when the client's turn has come. The time limit counts from now.
    /// 429: too many wait; 503: no turn came, or the service is being stopped; 504: it took too long; 499: the client
    /// has disconnected.
    http::Response answer(const http::Request& request, std::chrono::seconds limit,
                          const std::function<api::Answer(const RunControl&)>& work) const;

private:
    ComputeSlots& turns_;
    Timer& timer_;
    SpareCores& spare_cores_;
    std::stop_token closing_;
};

}  // namespace tunewright::server
