// What the service does by the clock, and what it does on notices of other processes that use the same store.
#include <algorithm>
#include <set>

#include "server/jobs/service.h"

namespace tunewright::server {
namespace {

constexpr int kPollsPerUpkeep = 2;
constexpr int kCountingShare = 20;  // of the time at most one part goes into counting a long queue
constexpr std::chrono::milliseconds kShortest{1};
constexpr std::chrono::milliseconds kUnbegun{250};  // then others may have what no worker here has begun

}  // namespace

void JobService::hear(const StoreNotice& notice) {
    switch (notice.kind) {
        case StoreNotice::Kind::queued: return claims_.arrived();
        case StoreNotice::Kind::cancel: return stop_running({notice.id});
        case StoreNotice::Kind::ended: return notice.id.empty() ? look_again() : tell_ended(notice.id);
        case StoreNotice::Kind::progress: return followers_.changed(notice.id);
    }
}

std::chrono::milliseconds JobService::tend() {
    const auto now = HeldJob::Clock::now();
    if (now >= next_beat_) {
        next_beat_ = now + heartbeats_.interval();
        heartbeats_.beat();
        if (store_.shared())
            for (const auto& held : claims_.withdraw(now - kUnbegun)) outbox_.release(held);
    }
    if (now >= next_upkeep_) {
        next_upkeep_ = now + kPollsPerUpkeep * settings_.poll;
        rescuer_.look();
        outbox_.retry();
        claims_.retry();
        if (store_.shared()) claims_.arrived();
    }
    const auto next = std::min(next_beat_, next_upkeep_) - HeldJob::Clock::now();
    return std::clamp(std::chrono::ceil<std::chrono::milliseconds>(next), kShortest, sweeper_.sweep());
}

std::chrono::milliseconds JobService::look() {
    const auto now = HeldJob::Clock::now();
    try {
        store_.start_due(settings_.now(), [this](Outcome<std::size_t> outcome) {
            if (const auto* fault = std::get_if<StoreFault>(&outcome))
                outage_.failed("no job can be started at its time", *fault);
            else if (std::get<std::size_t>(outcome) > 0)
                claims_.arrived();
        });
        if (now >= next_depth_) {
            depth_.refresh(store_);
            claims_.suspects(depth_.now().suspects);
            if (depth_.now().paused) give_back_unbegun();
            const auto took = HeldJob::Clock::now() - now;
            next_depth_ =
                now + std::max<HeldJob::Clock::duration>(kPollsPerUpkeep * settings_.poll, kCountingShare * took);
        }
        std::vector<std::string> ids;
        if (look_again_.exchange(false) || store_.shared()) ids = waits_.ids();
        if (ids.empty()) return settings_.poll;
        std::set<std::string> going;
        for (const JobState& state : store_.states(ids))
            if (!has_ended(state.status)) going.insert(state.id);
        for (const std::string& id : ids)
            if (!going.contains(id)) waits_.notify(id);
    } catch (const StoreError& error) {
        outage_.failed("it cannot be read", {error.kind, error.what()});
        look_again_ = true;
    }
    return settings_.poll;
}

}  // namespace tunewright::server
