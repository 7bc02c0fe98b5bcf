#include "server/jobs/service.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "server/jobs/running/result_outbox.h"
#include "server/log.h"
#include "server/random.h"

namespace tunewright::server {

namespace {

using Stop = HeldJob::Stop;

constexpr std::chrono::seconds kStopPatience{2};

// A header cannot contain it: the leading space would be removed.
constexpr const char* kUniqueKey = " unique ";

/// The job as the store now has it.
JobRecord record_of(const Ended& ended) {
    JobRecord job = ended.held->job;
    job.status = ended.end.status;
    job.finished_at = ended.end.finished_at;
    job.result = ended.end.result;
    job.error = ended.end.error;
    job.outline = ended.end.outline;
    return job;
}

JobSettings named(JobSettings settings) {
    if (settings.name.empty()) settings.name = new_id();
    return settings;
}

}  // namespace

JobService::JobService(JobStore& store, Timer& timer, JobSettings settings)
    : store_(store),
      settings_(named(std::move(settings))),
      depth_(settings_.queue_limit, settings_.entry_limit),
      waits_(timer),
      followers_(store, held_, outage_, settings_.poll),
      claims_(store, held_, outage_, claim_settings()),
      outbox_(store, outage_, end_listener()),
      heartbeats_(store, held_, outage_, heartbeat_settings()),
      rescuer_(store, outage_, rescuer_settings()),
      workers_(claims_, outbox_, timer, worker_settings()),
      sweeper_(store, settings_.retention, settings_.now) {}

JobService::~JobService() { drain(std::chrono::seconds(0)); }

Recovery JobService::start() {
    Recovery recovery =
        store_.recover(settings_.now(), settings_.max_attempts, given_up_problem(settings_.max_attempts));
    if (settings_.observer.recovered) settings_.observer.recovered(recovery);
    depth_.refresh(store_);
    looking_ = std::make_unique<PeriodicThread>([this] { return look(); });
    store_.watch([this](const StoreNotice& notice) { hear(notice); });
    workers_.start();
    claims_.arrived();
    tending_ = std::make_unique<PeriodicThread>([this] { return tend(); });
    return recovery;
}

// ---- accepting -------------------------------------------------------------------------------------------------

void JobService::submit(Order order, std::function<void(Submission)> done, WaitEnd ended) {
    if (draining_) return done({Submission::Kind::draining, {}, {}});
    if (order.job.unique) order.idempotency_key = kUniqueKey + order.job.request_hash;
    const auto place = depth_.reserve();
    if (!place) return done(submission_of_key(order));
    NewJob job;
    job.id = new_id();
    job.name = std::move(order.job.name);
    job.timeout_s = order.job.timeout_s;
    job.request_hash = std::move(order.job.request_hash);
    job.unique = order.job.unique;
    job.idempotency_key = std::move(order.idempotency_key);
    job.client_limit = settings_.client_jobs;
    job.owner = std::move(order.owner);
    job.flow = std::move(order.flow);
    job.origin = std::move(order.origin);
    job.created_at = settings_.now();
    job.not_before = order.job.not_before;
    job.priority = order.job.low_priority ? Priority::low : Priority::normal;
    job.notify = target_of(order.job.notify);
    auto request = std::make_shared<std::string>(order.job.request_json);
    job.request = std::move(order.job.request_json);

    const auto accepted = [this, request, place, wait = order.wait, done = std::move(done),
                           ended = std::move(ended)](Outcome<Accepted> outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) {
            place->end(false);
            outage_.failed("no job can be accepted", *fault);
            return done({Submission::Kind::store_failed, {}, *fault});
        }
        outage_.worked();
        auto& value = std::get<Accepted>(outcome);
        Submission submission;
        static_cast<JobSummary&>(submission.job) = std::move(value.job);
        if (value.kind != Accepted::Kind::created) {
            place->end(false);
            const bool same = value.kind == Accepted::Kind::existing;
            submission.kind = same ? Submission::Kind::existing : Submission::Kind::conflict;
            if (value.kind == Accepted::Kind::too_many) {
                submission.kind = Submission::Kind::too_many;
                if (settings_.observer.limited) settings_.observer.limited();
            }
            return done(std::move(submission));
        }
        place->end(true);
        submission.kind = Submission::Kind::created;
        submission.job.request = std::move(*request);
        // Before a worker of this process can know the job, so that its end is not missed.
        if (wait.count() > 0) waits_.add(submission.job.id, wait, ended);
        const std::string id = submission.job.id;
        done(std::move(submission));
        claims_.arrived();
        // Earlier waits have been notified that the service stops; this one has not.
        if (draining_) waits_.notify(id);
    };
    store_.accept(std::move(job), accepted);
}

/// The answer of a full queue: the job that was accepted before with the same key, if there is one.
Submission JobService::submission_of_key(const Order& order) {
    Submission full{Submission::Kind::queue_full, {}, {}};
    if (order.idempotency_key.empty()) return full;
    try {
        const std::optional<JobState> known = store_.job_of_key(order.owner, order.idempotency_key);
        const bool again = order.job.unique && known && transition(known->status, JobEvent::requeue);
        if (!known || again) return full;
        Submission submission;
        const bool same = known->request_hash == order.job.request_hash;
        submission.kind = same ? Submission::Kind::existing : Submission::Kind::conflict;
        static_cast<JobSummary&>(submission.job) = *known;
        return submission;
    } catch (const StoreError& error) {
        return {Submission::Kind::store_failed, {}, {error.kind, error.what()}};
    }
}

int JobService::seconds_until_room() const {
    // A hundredth of the queue: a client that returns finds room for more than one job.
    const double jobs = std::max(1.0, 0.01 * static_cast<double>(settings_.queue_limit));
    const double at_once = std::max(1.0, static_cast<double>(settings_.workers));
    return static_cast<int>(std::clamp(std::ceil(jobs * claims_.pace() / at_once), 1.0, 60.0));
}

std::optional<JobView> JobService::find(const std::string& id) {
    const std::shared_ptr<HeldJob> held = held_.find(id);
    std::optional<JobRecord> job = store_.find(id);
    if (!job) return std::nullopt;
    JobView view{*std::move(job), std::nullopt};
    if (held && view.job.status == JobStatus::running && view.job.attempts == held->job.attempts)
        view.progress = held->progress();
    return view;
}

std::optional<JobState> JobService::state(const std::string& id) {
    std::vector<JobState> found = store_.states({id});
    if (found.empty()) return std::nullopt;
    return std::move(found.front());
}

void JobService::cancel(const std::string& id, Done<CancelEffect> done) {
    store_.cancel(id, settings_.now(), [this, id, done = std::move(done)](Outcome<CancelEffect> outcome) {
        const auto* effect = std::get_if<CancelEffect>(&outcome);
        if (effect != nullptr && *effect == CancelEffect::cancelled) {
            depth_.gone(1);
            tell_ended(id);
        }
        if (effect != nullptr && *effect == CancelEffect::requested) stop_running({id});
        done(std::move(outcome));
    });
}

void JobService::requeue(const std::string& id, Done<RequeueEffect> done) {
    const std::optional<JobState> found = state(id);
    if (!found) return done(RequeueEffect::none);
    if (!transition(found->status, JobEvent::requeue)) return done(RequeueEffect::not_failed);
    const bool entry = !found->batch.empty();
    const auto place = entry ? nullptr : depth_.reserve();
    if (entry ? !depth_.reserve_entries(1) : !place) return done(RequeueEffect::queue_full);
    store_.requeue(id, [this, place, entry, done = std::move(done)](Outcome<RequeueEffect> outcome) {
        const auto* effect = std::get_if<RequeueEffect>(&outcome);
        const bool waits = effect != nullptr && *effect == RequeueEffect::requeued;
        if (entry && !waits) depth_.gone(0, 1);
        if (place) place->end(waits);
        done(outcome);
        claims_.arrived();
    });
}

void JobService::pause(bool paused, Done<bool> done) {
    store_.pause(paused, [this, paused, done = std::move(done)](Outcome<bool> outcome) {
        if (std::holds_alternative<bool>(outcome)) depth_.paused(paused);
        if (paused) give_back_unbegun();
        done(outcome);
        if (!paused) claims_.arrived();
        look_again();
    });
}

/// Claimed jobs that no worker has begun are queued again.
void JobService::give_back_unbegun() {
    for (const auto& held : claims_.withdraw(HeldJob::Clock::now())) outbox_.release(held);
}

void JobService::wait(const std::string& id, std::chrono::duration<double> wait, WaitEnd ended) {
    waits_.add(id, wait, std::move(ended));
    // It may have ended before the wait was registered.
    const std::optional<JobState> found = state(id);
    if (!found || has_ended(found->status) || draining_) waits_.notify(id);
}

// ---- interface for batches -------------------------------------------------------------------------------------

bool JobService::room_for_entries(std::size_t count) { return depth_.reserve_entries(count); }

void JobService::work_arrived() { claims_.arrived(); }

void JobService::stop_running(const std::vector<std::string>& ids) {
    for (const std::string& id : ids)
        if (const auto held = held_.find(id)) stop_held(held, Stop::cancel);
}

void JobService::batch_dropped(const std::string& batch) {
    for (const auto& held : held_.all())
        if (held->job.batch == batch) stop_held(held, Stop::dropped);
}

void JobService::look_again() {
    look_again_ = true;
    followers_.changed("");
    if (looking_) looking_->wake();
}

// ---- events of held jobs ---------------------------------------------------------------------------------------

ClaimSettings JobService::claim_settings() {
    ClaimSettings made;
    made.worker = settings_.name;
    made.lease = settings_.lease;
    made.now = settings_.now;
    made.max_held += settings_.workers;
    made.claimed = [this](const std::vector<JobRecord>& jobs) {
        std::size_t singles = 0;
        for (const JobRecord& job : jobs) singles += job.batch.empty() ? 1U : 0U;
        depth_.gone(singles, jobs.size() - singles);
    };
    made.late = [this](const std::shared_ptr<HeldJob>& held) { outbox_.release(held); };
    return made;
}

ResultOutbox::Listener JobService::end_listener() {
    ResultOutbox::Listener made;
    made.done = [this](const Ended& end, bool kept) { ended(end, kept); };
    made.released = [this](const std::shared_ptr<HeldJob>& held) {
        held_.forget(held);
        // It is queued again, or was cancelled if that was requested meanwhile.
        look_again();
        claims_.arrived();
    };
    made.unsaved = [this](std::size_t bytes) { claims_.unsaved(bytes); };
    return made;
}

HeartbeatSettings JobService::heartbeat_settings() {
    HeartbeatSettings made;
    made.worker = settings_.name;
    made.lease = settings_.lease;
    made.poll = settings_.poll;
    made.shared = store_.shared();
    made.now = settings_.now;
    made.cancelled = [this](const std::shared_ptr<HeldJob>& held) { stop_held(held, Stop::cancel); };
    made.lost = [this](const std::shared_ptr<HeldJob>& held) { stop_held(held, Stop::lost); };
    return made;
}

RescuerSettings JobService::rescuer_settings() {
    RescuerSettings made;
    made.lease = settings_.lease;
    made.period = 2 * settings_.poll;
    made.shared = store_.shared();
    made.max_attempts = settings_.max_attempts;
    made.given_up = given_up_problem(settings_.max_attempts);
    made.now = settings_.now;
    made.clock_jumped = [this] { heartbeats_.beat(); };
    made.recovered = [this](const Recovery& found) {
        log_info(std::to_string(found.interrupted) + " jobs of a process that has died are queued again, " +
                 std::to_string(found.given_up) + " were given up");
        if (settings_.observer.recovered) settings_.observer.recovered(found);
        for (const std::string& id : found.ended) tell_ended(id);
        claims_.arrived();
    };
    return made;
}

WorkerSettings JobService::worker_settings() {
    WorkerSettings made;
    made.count = settings_.workers;
    made.version = settings_.version;
    made.run = settings_.run;
    made.now = settings_.now;
    made.begun = settings_.observer.begun;
    made.lost = [this](const std::shared_ptr<HeldJob>& held) { forget(held); };
    return made;
}

void JobService::ended(const Ended& end, bool kept) {
    if (!kept) return forget(end.held);
    if (settings_.observer.ended) settings_.observer.ended(end);
    held_.forget(end.held);
    claims_.freed();
    waits_.notify(end.held->job.id, [&end] { return record_of(end); });
    followers_.changed(end.held->job.id);
}

void JobService::tell_ended(const std::string& id) {
    waits_.notify(id);
    followers_.changed(id);
}

/// Another process has it, or it was deleted: the result here is dropped.
void JobService::forget(const std::shared_ptr<HeldJob>& held) {
    held_.forget(held);
    claims_.freed();
    if (settings_.observer.dropped && held->why() != Stop::dropped) settings_.observer.dropped();
    look_again();
}

void JobService::stop_held(const std::shared_ptr<HeldJob>& held, Stop why) {
    held->request(why);
    if (claims_.withdraw(held)) workers_.end_unbegun(held);
}

// ---- stopping --------------------------------------------------------------------------------------------------

bool JobService::drain(std::chrono::duration<double> grace) {
    if (drained_) return *drained_;
    draining_ = true;
    workers_.request_stop();
    for (const auto& held : claims_.close(kStopPatience)) outbox_.release(held);
    bool idle = held_.wait_until_none(grace);
    if (!idle) {
        for (const auto& held : held_.all()) stop_held(held, Stop::shutdown);
        idle = held_.wait_until_none(kStopPatience);
    }
    waits_.tell_all();
    if (tending_) tending_->stop();
    if (looking_) looking_->stop();
    followers_.close();
    if (idle) workers_.join();
    drained_ = idle;
    return idle;
}

namespace {

constexpr int kPollsPerUpkeep = 2;
constexpr int kMinPauseOverCounting = 20;  // counting a long queue takes at most one part in this number of the time
constexpr std::chrono::milliseconds kShortest{1};
constexpr std::chrono::milliseconds kMaxUnbegunTime{250};  // after this time other processes may take claimed jobs that
                                                           // no worker here has begun

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
            for (const auto& held : claims_.withdraw(now - kMaxUnbegunTime)) outbox_.release(held);
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
            next_depth_ = now + std::max<HeldJob::Clock::duration>(kPollsPerUpkeep * settings_.poll,
                                                                   kMinPauseOverCounting * took);
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
