// Single jobs: accepted, ended, cancelled, queued again, removed.
#include "server/store/sqlite/changes.h"
#include "server/store/sqlite/moves.h"
#include "server/store/sqlite/reading.h"

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

/// A job that is not of a batch being deleted.
struct FoundJob : Place {
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
    static_cast<Place&>(found) = read_place(row);
    found.status = job_status(row.text(7)).value();
    found.batch_cancelled = row.integer(8) != 0;
    return found;
}

/// The single jobs of its flow are counted only where so many have come since the last count that there may be no room.
bool has_room(Connection& store, ClientBounds& bounds, const NewJob& job) {
    constexpr std::size_t most_flows = 10'000;
    if (job.client_limit == 0) return true;
    if (bounds.size() > most_flows) bounds.clear();
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

/// The job's place in the queue: by its time where that has not come, else by the next turn of its flow.
void find_turn(Connection& store, Place& job, std::optional<UnixMs> not_before, UnixMs now) {
    const bool later = not_before.value_or(0) > now;
    job.turn = later ? *not_before : next_turn(store, job.priority, job.flow);
    if (later) job.priority = kScheduled;
}

/// A job gives its key up to a unique one, and keeps it behind its id.
void give_key_up(Connection& store, std::int64_t seq) {
    store.use("UPDATE jobs SET idempotency_key = ' ' || id || idempotency_key WHERE seq = ?1").with(seq).run();
}

/// Where the job has given its key up it takes it back; false where a later one has it that has not failed.
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

void move_in_batch(Connection& store, const Place& job, JobStatus from, JobStatus to, UnixMs ended_at = 0) {
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
    Place place{0, priority, 0, job.flow, {}, 0, 0};
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
    const std::optional<Run> run = take_running(store, end.seq, end.attempts);
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
    Place scheduled = *found;
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
        // What could never be read cannot be computed either.
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

}  // namespace tunewright::server
