#include "server/jobs/running/leases.h"

#include <algorithm>
#include <utility>

#include "api/service.h"

namespace tunewright::server {
namespace {

constexpr std::chrono::milliseconds kYoung{250};  // most jobs have ended by then and need no renewal

}  // namespace

Leases::Leases(JobStore& store, HeldJobs& held, Outage& outage, LeaseSettings settings)
    : store_(store), held_(held), outage_(outage), settings_(std::move(settings)) {}

std::chrono::milliseconds Leases::interval() const {
    const auto third = std::max(settings_.lease / 3, std::chrono::milliseconds(1));
    return store_.shared() ? std::min(settings_.poll, third) : third;
}

void Leases::renew() { renew(HeldJob::Clock::now() - std::min(kYoung, settings_.lease / 6)); }

void Leases::renew(HeldJob::Clock::time_point young) {
    if (renewing_.exchange(true)) return;
    std::vector<Renewal> renewals;
    std::vector<std::shared_ptr<HeldJob>> asked;
    std::map<std::string, std::pair<int, unsigned>> sent;
    if (resend_.exchange(false)) sent_.clear();
    for (const auto& held : held_.all()) {
        if (held->claimed_at > young) continue;
        Renewal renewal{held->job.id, held->job.attempts, ""};
        const std::pair revision{held->job.attempts, held->revision()};
        const auto last = sent_.find(renewal.id);
        if (revision.second > 0 && (last == sent_.end() || last->second != revision))
            renewal.progress = api::progress_json(*held->progress());
        sent.emplace(renewal.id, revision);
        renewals.push_back(std::move(renewal));
        asked.push_back(held);
    }
    sent_ = std::move(sent);
    if (renewals.empty()) {
        renewing_ = false;
        return;
    }
    store_.renew(std::move(renewals), settings_.now(), settings_.lease, [this, asked](const auto& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) {
            resend_ = true;
            outage_.failed("no lease can be renewed", *fault);
        } else {
            outage_.worked();
            renewed(asked, std::get<std::vector<Renewed>>(outcome));
        }
        renewing_ = false;
    });
}

void Leases::renewed(const std::vector<std::shared_ptr<HeldJob>>& asked, const std::vector<Renewed>& answers) {
    for (std::size_t i = 0; i < std::min(asked.size(), answers.size()); i++) {
        const std::shared_ptr<HeldJob>& held = asked[i];
        // One whose end is on its way into the store is sent there.
        if (held->stage() == HeldJob::Stage::ending || held_.find(held->job.id) != held) continue;
        if (!answers[i].held)
            settings_.lost(held);
        else if (answers[i].cancel_requested)
            settings_.cancelled(held);
    }
}

bool Leases::clock_jumped() {
    const UnixMs wall = settings_.now();
    const auto steady = HeldJob::Clock::now();
    const std::chrono::milliseconds by_wall(wall - std::exchange(last_wall_, wall));
    const auto by_steady = steady - std::exchange(last_steady_, steady);
    return by_wall - by_steady > settings_.lease / 4;
}

void Leases::reclaim() {
    // The machine slept, or its clock was set: leases of the living would seem to be over.
    if (clock_jumped()) return renew(HeldJob::Clock::now());
    if (reclaiming_.exchange(true)) return;
    const Reclaim what{settings_.now(), settings_.most_attempts, settings_.given_up, store_.shared()};
    store_.reclaim(what, [this](const auto& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) {
            outage_.failed("nobody looks for jobs of processes that have gone", *fault);
        } else {
            const auto& found = std::get<Recovery>(outcome);
            if (found.interrupted > 0 || !found.ended.empty()) settings_.reclaimed(found);
        }
        reclaiming_ = false;
    });
}

}  // namespace tunewright::server
