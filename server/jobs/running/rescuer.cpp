#include "server/jobs/running/rescuer.h"

#include <utility>

namespace tunewright::server {

bool Rescuer::clock_jumped() {
    const UnixMs wall = settings_.now();
    const auto steady = HeldJob::Clock::now();
    const std::chrono::milliseconds by_wall(wall - std::exchange(last_wall_, wall));
    const auto by_steady = steady - std::exchange(last_steady_, steady);
    return by_wall - by_steady > settings_.lease / 4;
}

void Rescuer::look() {
    if (clock_jumped()) return settings_.clock_jumped();
    if (looking_.exchange(true)) return;
    const Reclaim what{settings_.now(), settings_.most_attempts, settings_.given_up, settings_.shared,
                       settings_.period};
    queue_.reclaim(what, [this](const auto& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) {
            outage_.failed("nobody looks for jobs of processes that have gone", *fault);
        } else {
            const auto& found = std::get<Recovery>(outcome);
            if (found.interrupted > 0 || !found.ended.empty()) settings_.recovered(found);
        }
        looking_ = false;
    });
}

}  // namespace tunewright::server
