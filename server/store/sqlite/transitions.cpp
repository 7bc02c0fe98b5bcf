#include "server/store/sqlite/transitions.h"

#include <algorithm>

namespace tunewright::server {
namespace {

const std::string kNone;

void bind_batch(Connection::Use& row, int place, const std::optional<std::int64_t>& batch) {
    batch ? row.bind(place, *batch) : row.bind_null(place);
}

}  // namespace

Ending Ending::cancelled(UnixMs at) { return {JobStatus::cancelled, at, true, kNone, kNone, kNone, kNone}; }

Ending Ending::failed(UnixMs at, const std::string& error) {
    return {JobStatus::failed, at, false, kNone, kNone, error, kNone};
}

std::int64_t next_turn(Connection& store, int priority, const std::string& flow) {
    // The turn being served is the one before the first that waits; a job that has crashed twice waits out of turn.
    Connection::Use row = store.use(
        "SELECT 1 + max(0, coalesce((SELECT turn - 1 FROM waiting WHERE class = ?1 AND crashes < 2 "
        "ORDER BY turn LIMIT 1), 0), coalesce((SELECT max(turn) FROM waiting WHERE class = ?1 AND flow = ?2), 0))");
    row.with(priority, flow).next();
    return row.integer(0);
}

RowPosition read_place(const Connection::Use& row) {
    RowPosition job;
    job.seq = row.integer(0);
    job.priority = static_cast<int>(row.integer(1));
    job.turn = row.integer(2);
    job.flow = row.text(3);
    job.batch = row.moment(4);
    job.attempts = static_cast<int>(row.integer(5));
    job.crashes = static_cast<int>(row.integer(6));
    return job;
}

void put_waiting(Connection& store, const RowPosition& job, std::optional<UnixMs> not_before) {
    Connection::Use row = store.use(
        "INSERT INTO waiting (class, turn, seq, flow, attempts, crashes, batch, not_before) "
        "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8)");
    row.with(job.priority, job.turn, job.seq, job.flow, job.attempts, job.crashes);
    bind_batch(row, 7, job.batch);
    bind_batch(row, 8, not_before);
    row.run();
}

bool take_waiting(Connection& store, const RowPosition& job) {
    return store.use("DELETE FROM waiting WHERE class = ?1 AND turn = ?2 AND seq = ?3")
               .with(job.priority, job.turn, job.seq)
               .run() > 0;
}

void put_running(Connection& store, const RowPosition& job, const std::string& worker, UnixMs now) {
    Connection::Use row = store.use(
        "INSERT INTO running (seq, class, turn, flow, worker, attempts, crashes, started_at, batch) "
        "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9)");
    row.with(job.seq, job.priority, job.turn, job.flow, worker, job.attempts, job.crashes, now);
    bind_batch(row, 9, job.batch);
    row.run();
}

std::optional<RunningJob> take_running(Connection& store, std::int64_t seq, std::optional<int> attempts) {
    Connection::Use row = store.use(
        "DELETE FROM running WHERE seq = ?1 AND (?2 = 0 OR attempts = ?2) "
        "RETURNING seq, class, turn, flow, batch, attempts, crashes, started_at, cancel_requested");
    if (!row.with(seq, attempts.value_or(0)).next()) return std::nullopt;
    RunningJob run;
    static_cast<RowPosition&>(run) = read_place(row);
    run.started_at = row.integer(7);
    run.cancel_requested = row.integer(8) != 0;
    return run;
}

void put_ended(Connection& store, const RowPosition& job, std::optional<UnixMs> started_at, const Ending& ending) {
    {
        Connection::Use row = store.use(
            "INSERT INTO ended (seq, single, status, attempts, cancel_requested, finished_at, version, outline, error, "
            "result, started_at) VALUES (?1, ?2, ?3, ?4, ?5, ?6, nullif(?7, ''), nullif(?8, ''), nullif(?9, ''), "
            "nullif(?10, ''), ?11)");
        const std::string status(to_string(ending.status));
        row.with(job.seq, job.batch ? 0 : 1, status, job.attempts, ending.cancel_requested ? 1 : 0, ending.at,
                 ending.version, ending.outline, ending.error, ending.result);
        bind_batch(row, 11, started_at);
        row.run();
    }
    if (job.batch) return;  // the notification belongs to the end of the batch
    store
        .use(
            "INSERT INTO deliveries (target, job, created_at, due_at) "
            "SELECT notify, id, ?2, ?2 FROM jobs WHERE seq = ?1 AND notify IS NOT NULL")
        .with(job.seq, ending.at)
        .run();
}

std::int64_t& BatchCounts::Change::of(JobStatus status) {
    switch (status) {
        case JobStatus::queued: return queued;
        case JobStatus::running: return running;
        case JobStatus::succeeded: return succeeded;
        case JobStatus::failed: return failed;
        case JobStatus::cancelled: break;
    }
    return cancelled;
}

void BatchCounts::move(const std::optional<std::int64_t>& batch, std::optional<JobStatus> from,
                       std::optional<JobStatus> to, UnixMs ended_at) {
    if (!batch) return;
    Change& change = changes_[*batch];
    if (from) change.of(*from)--;
    if (to) change.of(*to)++;
    change.last_end = std::max(change.last_end, ended_at);
}

void BatchCounts::write(Connection& store) const {
    for (const auto& [batch, change] : changes_)
        store
            .use(
                "UPDATE batches SET queued = queued + ?2, running = running + ?3, succeeded = succeeded + ?4, "
                "failed = failed + ?5, cancelled = cancelled + ?6, last_end = max(last_end, ?7) WHERE seq = ?1")
            .with(batch, change.queued, change.running, change.succeeded, change.failed, change.cancelled,
                  change.last_end)
            .run();
}

}  // namespace tunewright::server
