#include "server/jobs/running/heartbeats.h"

#include <algorithm>
#include <set>
#include <utility>

#include "api/service.h"

namespace tunewright::server {

Heartbeats::Heartbeats(JobQueue& queue, HeldJobs& held, StoreOutageLog& outage, HeartbeatSettings settings)
    : queue_(queue), held_(held), outage_(outage), settings_(std::move(settings)) {}

std::chrono::milliseconds Heartbeats::interval() const {
    const auto third = std::max(settings_.lease / 3, std::chrono::milliseconds(1));
    return settings_.shared ? std::min(settings_.poll, third) : third;
}

/// A process that holds nothing only has to check from time to time whether the store disagrees.
bool Heartbeats::is_due(const Asked& held) {
    const auto now = HeldJob::Clock::now();
    if (held.empty() && (!settings_.shared || now < last_ + settings_.lease / 3)) return false;
    last_ = now;
    return true;
}

std::vector<ProgressNote> Heartbeats::notes(const Asked& held) {
    if (resend_.exchange(false)) sent_.clear();
    std::vector<ProgressNote> notes;
    std::map<std::int64_t, std::pair<int, unsigned>> sent;
    for (const std::shared_ptr<HeldJob>& job : held) {
        const std::pair revision{job->job.attempts, job->revision()};
        const auto last = sent_.find(job->job.seq);
        if (revision.second > 0 && (last == sent_.end() || last->second != revision))
            notes.push_back({job->job.seq, job->job.id, job->job.attempts, api::progress_json(*job->progress())});
        sent.emplace(job->job.seq, revision);
    }
    sent_ = std::move(sent);
    return notes;
}

void Heartbeats::beat() {
    if (beating_.exchange(true)) return;
    const Asked asked = held_.all();
    if (!is_due(asked)) {
        beating_ = false;
        return;
    }
    queue_.beat({settings_.worker, settings_.now(), settings_.lease, notes(asked)}, [this, asked](const auto& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) {
            resend_ = true;
            outage_.failed("no heartbeat can be sent", *fault);
        } else {
            outage_.worked();
            heard(asked, std::get<std::vector<Holding>>(outcome));
        }
        beating_ = false;
    });
}

void Heartbeats::heard(const Asked& asked, const std::vector<Holding>& holdings) {
    std::map<std::int64_t, const Holding*> known;
    for (const Holding& holding : holdings) known[holding.seq] = &holding;
    for (const std::shared_ptr<HeldJob>& held : asked) {
        // A job whose end is being written to the store is handled there.
        if (held->stage() == HeldJob::Stage::ending || held_.find(held->job.id) != held) continue;
        const auto found = known.find(held->job.seq);
        if (found == known.end() || found->second->attempts != held->job.attempts)
            settings_.lost(held);
        else if (found->second->cancel_requested)
            settings_.cancelled(held);
    }
    release_strays(holdings);
}

/// Jobs that the store handed out in an answer that was lost: nobody computes them.
void Heartbeats::release_strays(const std::vector<Holding>& holdings) {
    std::set<std::int64_t> here;
    for (const auto& held : held_.all()) here.insert(held->job.seq);
    for (const Holding& holding : holdings) {
        const bool on_its_way = holding.since > settings_.now() - settings_.lease.count();
        if (here.contains(holding.seq) || on_its_way) continue;
        queue_.release(holding.seq, holding.attempts, [](const Outcome<bool>&) {});
    }
}

}  // namespace tunewright::server
