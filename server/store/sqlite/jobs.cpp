#include "server/store/sqlite/jobs.h"

#include "server/store/sqlite/reading.h"

namespace tunewright::server {
namespace {

std::optional<Accepted> find_by_key(Connection& store, const NewJob& job) {
    static const std::string sql = "SELECT " + kSummaryColumns + kSummaryTables +
                                   " JOIN idempotency_keys k ON k.seq = j.seq WHERE k.owner = ?1 AND k.key = ?2";
    Connection::Use row = store.use(sql);
    if (!row.with(job.owner, job.idempotency_key).next()) return std::nullopt;
    Accepted accepted;
    accepted.job = read_summary(row);
    accepted.kind = accepted.job.request_hash == job.request_hash ? Accepted::Kind::existing : Accepted::Kind::conflict;
    return accepted;
}

}  // namespace

std::optional<FoundJob> find_job(Connection& store, const std::string& id) {
    static const std::string sql =
        "SELECT j.seq, j.status, j.class FROM jobs j LEFT JOIN batches b ON b.seq = j.batch WHERE j.id = ?1 AND " +
        kVisible;
    Connection::Use row = store.use(sql);
    if (!row.with(id).next()) return std::nullopt;
    return FoundJob{row.integer(0), job_status(row.text(1)).value(), row.integer(2) != 0};
}

Accepted accept_job(Connection& store, const NewJob& job) {
    if (!job.idempotency_key.empty())
        if (std::optional<Accepted> earlier = find_by_key(store, job)) return *std::move(earlier);
    const std::int64_t turn = next_turn(store, 0, job.flow);
    store
        .use(
            "INSERT INTO jobs (id, name, status, class, turn, owner, flow, created_at, timeout_s, request_hash) "
            "VALUES (?1, ?2, 'queued', 0, ?3, ?4, ?5, ?6, ?7, ?8)")
        .with(job.id, job.name, turn, job.owner, job.flow, job.created_at, job.timeout_s, job.request_hash)
        .run();
    Accepted accepted;
    accepted.job.seq = store.database().getLastInsertRowid();
    store.use("INSERT INTO requests (seq, body) VALUES (?1, ?2)").with(accepted.job.seq, job.request).run();
    if (!job.idempotency_key.empty())
        store.use("INSERT INTO idempotency_keys (owner, key, seq) VALUES (?1, ?2, ?3)")
            .with(job.owner, job.idempotency_key, accepted.job.seq)
            .run();
    accepted.job.id = job.id;
    accepted.job.name = job.name;
    accepted.job.created_at = job.created_at;
    accepted.job.timeout_s = job.timeout_s;
    accepted.job.request_hash = job.request_hash;
    accepted.job.owner = job.owner;
    return accepted;
}

bool finish_job(Connection& store, const JobEnd& end) {
    std::int64_t seq = 0;
    {
        Connection::Use row = store.use(
            "UPDATE jobs SET status = ?3, finished_at = ?4, version = ?5, outline = nullif(?6, ''), "
            "worker = NULL, lease_until = NULL "
            "WHERE id = ?1 AND attempts = ?2 AND status = 'running' RETURNING seq");
        const std::string status(to_string(end.status));
        if (!row.with(end.id, end.attempts, status, end.finished_at, end.version, end.outline).next()) return false;
        seq = row.integer(0);
    }
    if (end.result.empty() && end.error.empty()) return true;
    store.use("INSERT INTO results (seq, body, error) VALUES (?1, nullif(?2, ''), nullif(?3, ''))")
        .with(seq, end.result, end.error)
        .run();
    return true;
}

CancelEffect cancel_job(Connection& store, const std::string& id, UnixMs now) {
    const std::optional<FoundJob> found = find_job(store, id);
    if (!found) return CancelEffect::none;
    if (has_ended(found->status)) return CancelEffect::ended;
    if (found->status == JobStatus::running) {
        store.use("UPDATE jobs SET cancel_requested = 1 WHERE seq = ?1").with(found->seq).run();
        return CancelEffect::requested;
    }
    store.use("UPDATE jobs SET cancel_requested = 1, status = 'cancelled', finished_at = ?2 WHERE seq = ?1")
        .with(found->seq, now)
        .run();
    return CancelEffect::cancelled;
}

RemoveEffect remove_job(Connection& store, const std::string& id) {
    const std::optional<FoundJob> found = find_job(store, id);
    if (!found) return RemoveEffect::none;
    if (found->in_batch) return RemoveEffect::in_batch;
    if (!has_ended(found->status)) return RemoveEffect::not_ended;
    store.use("DELETE FROM jobs WHERE seq = ?1").with(found->seq).run();
    return RemoveEffect::removed;
}

std::size_t sweep_jobs(Connection& store, UnixMs ended_before, std::size_t most) {
    const int gone = store
                         .use(
                             "DELETE FROM jobs WHERE seq IN (SELECT seq FROM jobs WHERE class = 0 AND "
                             "finished_at IS NOT NULL AND finished_at < ?1 ORDER BY finished_at LIMIT ?2)")
                         .with(ended_before, static_cast<std::int64_t>(most))
                         .run();
    return static_cast<std::size_t>(gone);
}

}  // namespace tunewright::server
