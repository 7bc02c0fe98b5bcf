#include "server/jobs/running/rescuer.h"

namespace tunewright::server {

void Rescuer::look() {
    const auto drift = drift_.since_last(settings_.now());
    if (!drift || *drift > settings_.lease / 4) return settings_.clock_jumped();
    if (looking_.exchange(true)) return;
    const Reclaim what{settings_.now(), settings_.max_attempts, settings_.given_up, settings_.shared, settings_.period};
    queue_.reclaim(what, [this](const auto& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) {
            outage_.failed("jobs of processes that have died are not searched for", *fault);
        } else {
            const auto& found = std::get<Recovery>(outcome);
            if (found.interrupted > 0 || !found.ended.empty()) settings_.recovered(found);
        }
        looking_ = false;
    });
}

}  // namespace tunewright::server
