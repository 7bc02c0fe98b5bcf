// Turns, claims and leases.
#include "server/store/sqlite/jobs.h"
#include "server/store/sqlite/reading.h"

namespace tunewright::server {

std::int64_t next_turn(Connection& store, int job_class, const std::string& flow) {
    // Served is the turn of the last job that was taken, and at least the one before the first that waits.
    Connection::Use row = store.use(
        "SELECT 1 + max(0, coalesce((SELECT max(turn) FROM jobs WHERE status = 'running' AND class = ?1), 0), "
        "coalesce((SELECT min(turn) - 1 FROM jobs WHERE status = 'queued' AND class = ?1), 0), "
        "coalesce((SELECT max(turn) FROM jobs WHERE status = 'queued' AND class = ?1 AND flow = ?2), 0))");
    row.with(job_class, flow).next();
    return row.integer(0);
}

std::vector<JobRecord> claim_jobs(Connection& store, const Claim& claim) {
    std::vector<std::int64_t> next;
    {
        Connection::Use row = store.use(
            claim.suspects ? "SELECT seq FROM jobs WHERE status = 'queued' AND crashes > 1 AND not_before <= ?2 "
                             "ORDER BY not_before LIMIT ?1"
                           : "SELECT seq FROM jobs WHERE status = 'queued' AND crashes < 2 AND ?2 IS NOT NULL "
                             "ORDER BY class, turn, seq LIMIT ?1");
        row.with(static_cast<std::int64_t>(claim.most), claim.now);
        while (row.next()) next.push_back(row.integer(0));
    }
    static const std::string read = "SELECT " + kRecordColumns + kRecordTables + " WHERE j.seq = ?1";
    std::vector<JobRecord> claimed;
    for (const std::int64_t seq : next) {
        store
            .use(
                "UPDATE jobs SET status = 'running', started_at = ?2, attempts = attempts + 1, worker = ?3, "
                "lease_until = ?4 WHERE seq = ?1")
            .with(seq, claim.now, claim.worker, claim.now + claim.lease.count())
            .run();
        Connection::Use row = store.use(read);
        if (row.with(seq).next()) claimed.push_back(read_record(row));
    }
    return claimed;
}

std::vector<Renewed> renew_jobs(Connection& store, const std::vector<Renewal>& renewals, UnixMs lease_until) {
    std::vector<Renewed> answers;
    for (const Renewal& renewal : renewals) {
        Renewed answer{renewal.id, false, false};
        std::int64_t seq = 0;
        {
            Connection::Use row = store.use(
                "UPDATE jobs SET lease_until = ?3 WHERE id = ?1 AND attempts = ?2 AND status = 'running' "
                "RETURNING seq, cancel_requested");
            if (row.with(renewal.id, renewal.attempts, lease_until).next()) {
                seq = row.integer(0);
                answer.held = true;
                answer.cancel_requested = row.integer(1) != 0;
            }
        }
        if (answer.held && !renewal.progress.empty())
            store.use("INSERT OR REPLACE INTO progress (seq, attempts, body) VALUES (?1, ?2, ?3)")
                .with(seq, renewal.attempts, renewal.progress)
                .run();
        answers.push_back(std::move(answer));
    }
    return answers;
}

bool release_job(Connection& store, const std::string& id, int attempts, UnixMs now) {
    // Whoever asked for its end while it ran gets that instead.
    const int cancelled =
        store
            .use(
                "UPDATE jobs SET status = 'cancelled', cancel_requested = 1, finished_at = ?3, worker = NULL, "
                "lease_until = NULL WHERE id = ?1 AND attempts = ?2 AND status = 'running' AND (cancel_requested "
                "OR EXISTS (SELECT 1 FROM batches b WHERE b.seq = batch AND b.cancel_requested))")
            .with(id, attempts, now)
            .run();
    if (cancelled > 0) return true;
    return store
               .use(
                   "UPDATE jobs SET status = 'queued', worker = NULL, lease_until = NULL "
                   "WHERE id = ?1 AND attempts = ?2 AND status = 'running'")
               .with(id, attempts)
               .run() > 0;
}

Recovery reclaim_jobs(Connection& store, UnixMs lease_at, UnixMs now, int attempts, const std::string& error) {
    Recovery recovery;
    {
        Connection::Use row = store.use(
            "UPDATE jobs SET status = 'cancelled', cancel_requested = 1, finished_at = ?2, worker = NULL, "
            "lease_until = NULL WHERE status = 'running' AND lease_until <= ?1 AND (cancel_requested OR EXISTS "
            "(SELECT 1 FROM batches b WHERE b.seq = batch AND b.cancel_requested)) RETURNING id");
        row.with(lease_at, now);
        while (row.next()) recovery.ended.push_back(row.text(0));
    }
    store
        .use(
            "INSERT OR REPLACE INTO results (seq, error) SELECT seq, ?3 FROM jobs "
            "WHERE status = 'running' AND lease_until <= ?1 AND crashes + 1 >= ?2")
        .with(lease_at, attempts, error)
        .run();
    {
        Connection::Use row = store.use(
            "UPDATE jobs SET status = 'failed', finished_at = ?3, worker = NULL, lease_until = NULL, crashes = crashes "
            "+ 1 "
            "WHERE status = 'running' AND lease_until <= ?1 AND crashes + 1 >= ?2 RETURNING id");
        row.with(lease_at, attempts, now);
        for (; row.next(); recovery.given_up++) recovery.ended.push_back(row.text(0));
    }
    recovery.interrupted =
        static_cast<std::size_t>(store
                                     .use("UPDATE jobs SET status = 'queued', worker = NULL, lease_until = NULL, "
                                          "crashes = crashes + 1, not_before = iif(crashes = 0, NULL, "
                                          "?2 + min(300000, 1000 << min(crashes - 1, 20))) "
                                          "WHERE status = 'running' AND lease_until <= ?1")
                                     .with(lease_at, now)
                                     .run());
    return recovery;
}

}  // namespace tunewright::server
