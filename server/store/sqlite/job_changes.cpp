#include "server/store/sqlite/job_changes.h"

#include "server/store/sqlite/reading.h"
#include "server/store/sqlite/transitions.h"

namespace tunewright::server {

namespace {

std::optional<Accepted> find_by_key(Connection& store, const NewJob& job) {
    static const std::string sql =
        "SELECT " + kSummaryColumns + kJobTables + " WHERE j.owner = ?1 AND j.idempotency_key = ?2";
    Connection::Use row = store.use(sql);
    if (!row.with(job.owner, job.idempotency_key).next()) return std::nullopt;
    Accepted accepted;
    accepted.job = read_summary(row);
    accepted.kind = accepted.job.request_hash == job.request_hash ? Accepted::Kind::existing : Accepted::Kind::conflict;
    return accepted;
}

/// A job whose batch is not being deleted.
struct FoundJob : RowPosition {
    JobStatus status = JobStatus::queued;
    bool batch_cancelled = false;
};

std::optional<FoundJob> find_job(Connection& store, const std::string& id) {
    static const std::string sql = "SELECT j.seq, j.class, j.turn, j.flow, j.batch, " + kAttempts +
                                   ", coalesce(w.crashes, 0), " + kStatus + ", coalesce(b.cancel_requested, 0)" +
                                   kJobTables + " WHERE j.id = ?1 AND " + kVisible;
    Connection::Use row = store.use(sql);
    if (!row.with(id).next()) return std::nullopt;
    FoundJob found;
    static_cast<RowPosition&>(found) = read_place(row);
    found.status = job_status(row.text(7)).value();
    found.batch_cancelled = row.integer(8) != 0;
    return found;
}

/// The single jobs of its flow are counted only if there may be no room after those that arrived since the last count.
bool has_room(Connection& store, ClientBounds& bounds, const NewJob& job) {
    constexpr std::size_t max_flows = 10'000;
    if (job.client_limit == 0) return true;
    if (bounds.size() > max_flows) bounds.clear();
    std::size_t& bound = bounds.try_emplace(job.flow, job.client_limit).first->second;
    if (bound >= job.client_limit) {
        Connection::Use row = store.use(
            "SELECT (SELECT count(*) FROM waiting WHERE class = 0 AND flow = ?1) + "
            "(SELECT count(*) FROM waiting WHERE class > 0 AND flow = ?1 AND batch IS NULL) + "
            "(SELECT count(*) FROM running WHERE flow = ?1 AND batch IS NULL)");
        row.with(job.flow).next();
        bound = static_cast<std::size_t>(row.integer(0));
    }
    return bound++ < job.client_limit;
}

/// The job's position in the queue: by its time if that has not come, else by the next turn of its flow.
void find_turn(Connection& store, RowPosition& job, std::optional<UnixMs> not_before, UnixMs now) {
    const bool later = not_before.value_or(0) > now;
    job.turn = later ? *not_before : next_turn(store, job.priority, job.flow);
    if (later) job.priority = kScheduled;
}

/// A job gives its key up to a unique one, and keeps it behind its id.
void give_key_up(Connection& store, std::int64_t seq) {
    store.use("UPDATE jobs SET idempotency_key = ' ' || id || idempotency_key WHERE seq = ?1").with(seq).run();
}

/// A job that has given its key up takes it back; false if a later job has it that has not failed.
bool take_key_back(Connection& store, std::int64_t seq) {
    NewJob given;
    {
        Connection::Use row = store.use(
            "SELECT owner, substr(idempotency_key, 2 + length(id)) FROM jobs WHERE seq = ?1 "
            "AND substr(idempotency_key, 1, 1 + length(id)) = ' ' || id");
        if (!row.with(seq).next()) return true;
        given.owner = row.text(0);
        given.idempotency_key = row.text(1);
    }
    if (const std::optional<Accepted> later = find_by_key(store, given)) {
        if (!transition(later->job.status, JobEvent::requeue)) return false;
        give_key_up(store, later->job.seq);
    }
    store.use("UPDATE jobs SET idempotency_key = ?2 WHERE seq = ?1").with(seq, given.idempotency_key).run();
    return true;
}

void move_in_batch(Connection& store, const RowPosition& job, JobStatus from, JobStatus to, UnixMs ended_at = 0) {
    BatchCounts counts;
    counts.move(job.batch, from, to, ended_at);
    counts.write(store);
}

}  // namespace

Accepted accept_job(Connection& store, ClientBounds& bounds, const NewJob& job) {
    std::optional<Accepted> earlier;
    if (!job.idempotency_key.empty()) earlier = find_by_key(store, job);
    if (earlier && !(job.unique && transition(earlier->job.status, JobEvent::requeue))) return *std::move(earlier);
    if (!has_room(store, bounds, job)) return {Accepted::Kind::too_many, {}};
    if (earlier) give_key_up(store, earlier->job.seq);
    const int priority = static_cast<int>(job.priority);
    RowPosition place{0, priority, 0, job.flow, {}, 0, 0};
    find_turn(store, place, job.not_before, job.created_at);
    const std::optional<UnixMs> time = place.priority == kScheduled ? job.not_before : std::nullopt;
    const std::string target = job.notify.text();
    store
        .use(
            "INSERT INTO jobs (id, name, owner, flow, class, turn, created_at, timeout_s, request_hash, "
            "idempotency_key, notify, request_id, traceparent, request, not_before) VALUES (?1, ?2, ?3, ?4, ?5, ?6, "
            "?7, ?8, ?9, nullif(?10, ''), nullif(?11, ''), ?12, ?13, ?14, nullif(?15, 0))")
        .with(job.id, job.name, job.owner, job.flow, priority, place.turn, job.created_at, job.timeout_s,
              job.request_hash, job.idempotency_key, target, job.origin.request_id, job.origin.traceparent, job.request,
              time.value_or(0))
        .run();
    place.seq = store.database().getLastInsertRowid();
    put_waiting(store, place);
    Accepted accepted{Accepted::Kind::created, summary_of(job)};
    accepted.job.seq = place.seq;
    accepted.job.not_before = time;
    return accepted;
}

bool finish_job(Connection& store, const JobEnd& end) {
    const std::optional<RunningJob> run = take_running(store, end.seq, end.attempts);
    if (!run) return false;
    put_ended(store, *run, run->started_at,
              {end.status, end.finished_at, run->cancel_requested, end.version, end.outline, end.error, end.result});
    move_in_batch(store, *run, JobStatus::running, end.status, end.finished_at);
    return true;
}

CancelEffect cancel_job(Connection& store, const std::string& id, UnixMs now) {
    const std::optional<FoundJob> found = find_job(store, id);
    if (!found) return CancelEffect::none;
    if (has_ended(found->status)) return CancelEffect::ended;
    if (found->status == JobStatus::running) {
        store.use("UPDATE running SET cancel_requested = 1 WHERE seq = ?1").with(found->seq).run();
        return CancelEffect::requested;
    }
    RowPosition scheduled = *found;
    scheduled.priority = kScheduled;
    if (!take_waiting(store, *found)) take_waiting(store, scheduled);
    put_ended(store, *found, std::nullopt, Ending::cancelled(now));
    move_in_batch(store, *found, JobStatus::queued, JobStatus::cancelled, now);
    return CancelEffect::cancelled;
}

RequeueEffect requeue_job(Connection& store, const std::string& id) {
    std::optional<FoundJob> found = find_job(store, id);
    if (!found) return RequeueEffect::none;
    if (!transition(found->status, JobEvent::requeue)) return RequeueEffect::not_failed;
    std::optional<UnixMs> not_before;
    {
        // A request that could not be read cannot be computed either.
        Connection::Use row = store.use("SELECT request IS NULL OR request = '', not_before FROM jobs WHERE seq = ?1");
        if (row.with(found->seq).next() && row.integer(0) != 0) return RequeueEffect::not_failed;
        not_before = row.moment(1);
    }
    if (found->batch_cancelled) return RequeueEffect::batch_cancelled;
    if (!take_key_back(store, found->seq)) return RequeueEffect::superseded;
    find_turn(store, *found, found->attempts == 0 ? not_before : std::nullopt, wall_clock());
    store.use("UPDATE jobs SET turn = ?2 WHERE seq = ?1").with(found->seq, found->turn).run();
    store.use("DELETE FROM ended WHERE seq = ?1").with(found->seq).run();
    put_waiting(store, *found);
    move_in_batch(store, *found, found->status, JobStatus::queued);
    if (found->batch) store.use("UPDATE batches SET ended_at = NULL WHERE seq = ?1").with(*found->batch).run();
    return RequeueEffect::requeued;
}

RemoveEffect remove_job(Connection& store, const std::string& id) {
    const std::optional<FoundJob> found = find_job(store, id);
    if (!found) return RemoveEffect::none;
    if (found->batch) return RemoveEffect::in_batch;
    if (!has_ended(found->status)) return RemoveEffect::not_ended;
    store.use("DELETE FROM ended WHERE seq = ?1").with(found->seq).run();
    store.use("DELETE FROM jobs WHERE seq = ?1").with(found->seq).run();
    return RemoveEffect::removed;
}

namespace {

constexpr const char* kNext = "SELECT seq, class, turn, flow, batch, attempts, crashes FROM waiting WHERE ";

std::vector<RowPosition> read_places(Connection::Use& row) {
    std::vector<RowPosition> places;
    while (row.next()) places.push_back(read_place(row));
    return places;
}

std::vector<RowPosition> next_places(Connection& store, const Claim& claim) {
    static const std::string usual =
        std::string(kNext) + "class < 2 AND crashes < 2 ORDER BY class, turn, seq LIMIT ?1";
    static const std::string low = std::string(kNext) + "crashes < 2 AND class = 1 ORDER BY turn, seq LIMIT ?1";
    static const std::string suspects =
        std::string(kNext) + "crashes > 1 AND " + pause_over("?2") + " ORDER BY not_before LIMIT ?1";
    const auto max = static_cast<std::int64_t>(claim.max);
    if (claim.suspects) {
        Connection::Use row = store.use(suspects);
        return read_places(row.with(max, claim.now));
    }
    if (claim.low_first) {
        Connection::Use row = store.use(low);
        if (std::vector<RowPosition> places = read_places(row.with(max)); !places.empty()) return places;
    }
    Connection::Use row = store.use(usual);
    return read_places(row.with(max));
}

void hear_of(Connection& store, const std::string& worker, UnixMs lease_until) {
    store
        .use(
            "INSERT INTO workers (name, lease_until) VALUES (?1, ?2) ON CONFLICT (name) DO UPDATE "
            "SET lease_until = ?2 WHERE lease_until < ?2")
        .with(worker, lease_until)
        .run();
}

/// True if a cancellation of the job or of its batch was requested: it takes the place of another attempt.
bool is_unwanted(Connection& store, const RunningJob& run) {
    if (run.cancel_requested) return true;
    if (!run.batch) return false;
    Connection::Use row = store.use("SELECT cancel_requested FROM batches WHERE seq = ?1");
    return row.with(*run.batch).next() && row.integer(0) != 0;
}

std::string id_of(Connection& store, std::int64_t seq) {
    Connection::Use row = store.use("SELECT id FROM jobs WHERE seq = ?1");
    return row.with(seq).next() ? row.text(0) : std::string{};
}

std::vector<std::int64_t> abandoned(Connection& store, UnixMs lease_at) {
    Connection::Use row = store.use(
        "SELECT r.seq FROM running r LEFT JOIN workers w ON w.name = r.worker "
        "WHERE coalesce(w.lease_until, 0) <= ?1");
    row.with(lease_at);
    std::vector<std::int64_t> found;
    while (row.next()) found.push_back(row.integer(0));
    return found;
}

}  // namespace

std::vector<JobRecord> claim_jobs(Connection& store, const Claim& claim) {
    if (is_paused(store)) return {};
    std::vector<JobRecord> claimed;
    BatchCounts counts;
    for (RowPosition& place : next_places(store, claim)) {
        take_waiting(store, place);
        place.attempts++;
        put_running(store, place, claim.worker, claim.now);
        counts.move(place.batch, JobStatus::queued, JobStatus::running);
        claimed.push_back(read_claimed(store, place.seq));
        claimed.back().attempts = place.attempts;
        claimed.back().started_at = claim.now;
    }
    counts.write(store);
    if (!claimed.empty()) hear_of(store, claim.worker, claim.now + claim.lease.count());
    return claimed;
}

bool any_due(Connection& store, UnixMs now) {
    Connection::Use row = store.use("SELECT 1 FROM waiting WHERE class = 2 AND turn <= ?1 LIMIT 1");
    return row.with(now).next();
}

std::size_t start_due(Connection& store, UnixMs now) {
    std::vector<RowPosition> due;
    {
        Connection::Use row = store.use(
            "SELECT w.seq, j.class, w.turn, w.flow, w.batch, w.attempts, w.crashes FROM waiting w "
            "JOIN jobs j ON j.seq = w.seq WHERE w.class = 2 AND w.turn <= ?1 ORDER BY w.turn, w.seq LIMIT 1000");
        due = read_places(row.with(now));
    }
    for (const RowPosition& job : due) {
        const std::int64_t turn = next_turn(store, job.priority, job.flow);
        store.use("UPDATE waiting SET class = ?3, turn = ?4 WHERE class = 2 AND turn = ?2 AND seq = ?1")
            .with(job.seq, job.turn, job.priority, turn)
            .run();
        store.use("UPDATE jobs SET turn = ?2 WHERE seq = ?1").with(job.seq, turn).run();
    }
    return due.size();
}

std::vector<Holding> beat_worker(Connection& store, const Heartbeat& beat) {
    hear_of(store, beat.worker, beat.now + beat.lease.count());
    for (const ProgressNote& note : beat.progress)
        store.use("UPDATE running SET progress = ?3 WHERE seq = ?1 AND attempts = ?2 AND worker = ?4")
            .with(note.seq, note.attempts, note.progress, beat.worker)
            .run();
    Connection::Use row =
        store.use("SELECT seq, attempts, cancel_requested, started_at FROM running WHERE worker = ?1");
    row.with(beat.worker);
    std::vector<Holding> held;
    while (row.next())
        held.push_back({row.integer(0), static_cast<int>(row.integer(1)), row.integer(2) != 0, row.integer(3)});
    return held;
}

bool release_job(Connection& store, std::int64_t seq, int attempts, UnixMs now) {
    const std::optional<RunningJob> run = take_running(store, seq, attempts);
    if (!run) return false;
    const bool unwanted = is_unwanted(store, *run);
    unwanted ? put_ended(store, *run, run->started_at, Ending::cancelled(now)) : put_waiting(store, *run);
    BatchCounts counts;
    counts.move(run->batch, JobStatus::running, unwanted ? JobStatus::cancelled : JobStatus::queued,
                unwanted ? now : 0);
    counts.write(store);
    return true;
}

Recovery reclaim_jobs(Connection& store, UnixMs lease_at, const Reclaim& what) {
    Recovery recovery;
    BatchCounts counts;
    for (const std::int64_t seq : abandoned(store, lease_at)) {
        RunningJob run = take_running(store, seq, std::nullopt).value();
        const bool unwanted = is_unwanted(store, run);
        run.crashes++;
        if (!unwanted && run.crashes < what.max_attempts) {
            std::optional<UnixMs> not_before;
            if (run.crashes > 1) not_before = what.now + pause_after(run.crashes).count();
            put_waiting(store, run, not_before);
            counts.move(run.batch, JobStatus::running, JobStatus::queued);
            recovery.interrupted++;
            continue;
        }
        const Ending ending = unwanted ? Ending::cancelled(what.now) : Ending::failed(what.now, what.error);
        put_ended(store, run, run.started_at, ending);
        counts.move(run.batch, JobStatus::running, ending.status, what.now);
        recovery.given_up += unwanted ? 0U : 1U;
        recovery.ended.push_back(id_of(store, seq));
    }
    counts.write(store);
    store.use("DELETE FROM workers WHERE lease_until <= ?1").with(lease_at).run();
    return recovery;
}

std::vector<Delivery> take_deliveries(Connection& store, UnixMs now, std::chrono::milliseconds hold, std::size_t max) {
    std::vector<Delivery> due;
    {
        Connection::Use row = store.use(
            "SELECT seq, target, job, batch, tries, created_at FROM deliveries WHERE due_at <= ?1 "
            "ORDER BY due_at LIMIT ?2");
        row.with(now, static_cast<std::int64_t>(max));
        while (row.next())
            due.push_back({row.integer(0), NotifyTarget::of_text(row.text(1)), row.text(2), row.text(3),
                           static_cast<int>(row.integer(4)), row.integer(5)});
    }
    for (const Delivery& delivery : due)
        store.use("UPDATE deliveries SET due_at = ?2 WHERE seq = ?1").with(delivery.seq, now + hold.count()).run();
    return due;
}

bool settle_delivery(Connection& store, std::int64_t seq, UnixMs now, std::optional<std::chrono::milliseconds> pause,
                     bool tried) {
    if (!pause) return store.use("DELETE FROM deliveries WHERE seq = ?1").with(seq).run() > 0;
    return store.use("UPDATE deliveries SET tries = tries + ?3, due_at = ?2 WHERE seq = ?1")
               .with(seq, now + pause->count(), tried ? 1 : 0)
               .run() > 0;
}

bool pause_queue(Connection& store, bool paused) {
    store.use("INSERT OR REPLACE INTO settings (name, value) VALUES ('paused', ?1)").with(paused ? "1" : "0").run();
    return true;
}

bool is_paused(Connection& store) {
    return store.number("SELECT count(*) FROM settings WHERE name = 'paused' AND value = '1'") > 0;
}

}  // namespace tunewright::server
