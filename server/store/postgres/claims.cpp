// Claims and leases. The database's clock alone decides when a lease is over.
#include <algorithm>
#include <map>

#include "server/store/postgres/changes.h"
#include "server/store/postgres/reading.h"
#include "server/store/postgres/text.h"

namespace tunewright::server::postgres {
namespace {

/// After the milliseconds of parameter `place`.
std::string lease_end(const std::string& place) {
    return "clock_timestamp() + " + place + "::bigint * interval '1 millisecond'";
}

/// True where whoever asked for the end of job j, or of its batch, gets that instead of another attempt.
const std::string kUnwanted =
    "(j.cancel_requested OR EXISTS (SELECT 1 FROM batches b WHERE b.seq = j.batch AND b.cancel_requested))";

}  // namespace

std::vector<JobRecord> claim_jobs(Session& session, const Claim& claim) {
    static const std::string usual = "crashes < 2 ORDER BY class, turn, seq";
    static const std::string suspects = "crashes > 1 AND not_before <= clock_timestamp() ORDER BY not_before";
    const std::string sql =
        "WITH next AS MATERIALIZED (SELECT seq FROM jobs WHERE status = 'queued' AND " +
        (claim.suspects ? suspects : usual) +
        " LIMIT $1 FOR UPDATE SKIP LOCKED), taken AS (UPDATE jobs j SET status = 'running', started_at = $2, "
        "attempts = j.attempts + 1, worker = $3, lease_until = " +
        lease_end("$4") + " FROM next WHERE j.seq = next.seq RETURNING j.*) SELECT " + kRecordColumns +
        " FROM taken j LEFT JOIN batches b ON b.seq = j.batch ORDER BY j.class, j.turn, j.seq";
    const Values values = Values()
                              .number(static_cast<std::int64_t>(claim.most))
                              .number(claim.now)
                              .text(claim.worker)
                              .number(claim.lease.count());
    std::vector<JobRecord> claimed;
    for (const pqxx::row& row : session.run(sql, values)) claimed.push_back(read_record(row));
    return claimed;
}

std::vector<Renewed> renew_jobs(Session& session, const std::vector<Renewal>& renewals,
                                std::chrono::milliseconds lease) {
    static const std::string sql =
        "UPDATE jobs j SET lease_until = " + lease_end("$4") +
        ", progress = CASE WHEN g.progress <> '' THEN g.progress ELSE j.progress END, "
        "progress_attempts = CASE WHEN g.progress <> '' THEN g.attempts ELSE j.progress_attempts END "
        "FROM unnest($1::text[], $2::int[], $3::text[]) AS g (id, attempts, progress) "
        "WHERE j.id = g.id AND j.attempts = g.attempts AND j.status = 'running' RETURNING j.id, j.cancel_requested";
    std::map<std::string, const Renewal*> in_order;  // as in finish_jobs()
    for (const Renewal& renewal : renewals) in_order[renewal.id] = &renewal;
    TextArray id, attempts, progress;
    for (const auto& [key, renewal] : in_order) {
        id.add(renewal->id);
        attempts.add_plain(std::to_string(renewal->attempts));
        progress.add(renewal->progress);
    }
    std::map<std::string, bool> held;
    const Values values =
        Values().plain(id.literal()).plain(attempts.literal()).plain(progress.literal()).number(lease.count());
    for (const pqxx::row& row : session.run(sql, values)) held[text_of(row[0])] = row[1].as<bool>();
    std::vector<Renewed> answers;
    for (const Renewal& renewal : renewals) {
        const auto found = held.find(renewal.id);
        const bool holds = found != held.end();
        answers.push_back({renewal.id, holds, holds && found->second});
    }
    return answers;
}

std::optional<JobStatus> release_job(Session& session, const std::string& id, int attempts, UnixMs now) {
    static const std::string sql = "UPDATE jobs j SET status = CASE WHEN " + kUnwanted +
                                   " THEN 'cancelled' ELSE 'queued' END, finished_at = CASE "
                                   "WHEN " +
                                   kUnwanted + " THEN $3::bigint END, cancel_requested = " + kUnwanted +
                                   ", worker = NULL, lease_until = NULL "
                                   "WHERE j.id = $1 AND j.attempts = $2 AND j.status = 'running' RETURNING j.status";
    const pqxx::result rows = session.run(sql, Values().text(id).number(attempts).number(now));
    if (rows.empty()) return std::nullopt;
    return job_status(rows[0][0].c_str());
}

Recovery reclaim_jobs(Session& session, UnixMs now, int attempts, const std::string& error) {
    static const std::string sql =
        "WITH over AS MATERIALIZED (SELECT j.seq, " + kUnwanted +
        " AS unwanted, j.crashes + 1 >= $1 AS tired FROM jobs j WHERE j.status = 'running' "
        "AND j.lease_until <= clock_timestamp() ORDER BY j.seq FOR UPDATE SKIP LOCKED) "
        "UPDATE jobs j SET status = CASE WHEN o.unwanted THEN 'cancelled' WHEN o.tired THEN 'failed' ELSE 'queued' "
        "END, finished_at = CASE WHEN o.unwanted OR o.tired THEN $3::bigint END, error = CASE WHEN o.tired AND NOT "
        "o.unwanted THEN $2 END, cancel_requested = o.unwanted, worker = NULL, lease_until = NULL, "
        "crashes = j.crashes + 1, not_before = CASE WHEN j.crashes > 0 THEN clock_timestamp() + "
        "least(300, 2 ^ (j.crashes - 1)) * interval '1 second' END "
        "FROM over o WHERE j.seq = o.seq RETURNING j.id, j.status";
    Recovery recovery;
    for (const pqxx::row& row : session.run(sql, Values().number(attempts).text(error).number(now))) {
        const JobStatus status = job_status(row[1].c_str()).value();
        if (status == JobStatus::queued) recovery.interrupted++;
        if (status == JobStatus::failed) recovery.given_up++;
        if (has_ended(status)) recovery.ended.push_back(text_of(row[0]));
    }
    return recovery;
}

}  // namespace tunewright::server::postgres
