// Claims, signs of life, and what becomes of the jobs of a worker that gives none. The database's clock alone decides
// when that is.
#include <algorithm>

#include "server/store/postgres/changes.h"
#include "server/store/postgres/moves.h"
#include "server/store/postgres/reading.h"
#include "server/store/postgres/text.h"

namespace tunewright::server::postgres {
namespace {

/// After the milliseconds of parameter `place`.
std::string lease_end(const std::string& place) {
    return "clock_timestamp() + " + place + "::bigint * interval '1 millisecond'";
}

/// Hands out the jobs that `which` names, of all that wait.
std::string claim_sql(const std::string& which) {
    return "WITH next AS MATERIALIZED (SELECT ctid FROM waiting WHERE " + which +
           " LIMIT $1 FOR UPDATE SKIP LOCKED), "
           "taken AS (DELETE FROM waiting WHERE ctid = ANY (ARRAY(SELECT ctid FROM next)) RETURNING *), "
           "runs AS (INSERT INTO running (seq, class, turn, flow, batch, worker, attempts, crashes, started_at) "
           "SELECT seq, class, turn, flow, batch, $2, attempts + 1, crashes, $3 FROM taken "
           "RETURNING seq, class, turn, attempts, batch, started_at), "
           // A sign of life, where the last one is not young enough to last.
           "alive AS (INSERT INTO workers (name, lease_until) SELECT $2, " +
           lease_end("$4") +
           " WHERE EXISTS (SELECT 1 FROM taken) AND NOT EXISTS (SELECT 1 FROM workers WHERE name = $2 "
           "AND lease_until > clock_timestamp() + $4::bigint / 2 * interval '1 millisecond') "
           "ON CONFLICT (name) DO UPDATE SET lease_until = greatest(workers.lease_until, EXCLUDED.lease_until)) "
           "SELECT " +
           kClaimedColumns +
           ", r.batch FROM runs r JOIN jobs j ON j.seq = r.seq LEFT JOIN batches b ON b.seq = r.batch "
           "ORDER BY r.class, r.turn, r.seq";
}

const std::string kGoing = "NOT EXISTS (SELECT 1 FROM settings WHERE name = 'paused' AND value = '1') AND ";

std::vector<JobRecord> claim_by(Session& session, const std::string& sql, const Claim& claim) {
    const Values values = Values()
                              .number(static_cast<std::int64_t>(claim.most))
                              .text(claim.worker)
                              .number(claim.now)
                              .number(claim.lease.count());
    std::vector<JobRecord> claimed;
    BatchCounts counts;
    for (const pqxx::row& row : session.run(sql, values)) {
        claimed.push_back(read_claimed(row));
        if (const pqxx::field batch = row[kClaimedCount]; !batch.is_null())
            counts.move(batch.as<std::int64_t>(), JobStatus::queued, JobStatus::running);
    }
    counts.write(session);
    return claimed;
}

}  // namespace

std::vector<JobRecord> claim_jobs(Session& session, const Claim& claim) {
    static const std::string usual = claim_sql(kGoing + "class < 2 AND crashes < 2 ORDER BY class, turn, seq");
    static const std::string low = claim_sql(kGoing + "crashes < 2 AND class = 1 ORDER BY class, turn, seq");
    static const std::string suspects = claim_sql(kGoing + "crashes > 1 AND " + kPauseOver + " ORDER BY not_before");
    if (claim.suspects) return claim_by(session, suspects, claim);
    if (claim.low_first)
        if (std::vector<JobRecord> claimed = claim_by(session, low, claim); !claimed.empty()) return claimed;
    return claim_by(session, usual, claim);
}

bool any_due(Session& session) {
    static const std::string sql = "SELECT EXISTS (SELECT 1 FROM waiting WHERE class = 2 AND turn <= " + kClock + ")";
    return session.run(sql)[0][0].as<bool>();
}

std::size_t start_due(Session& session) {
    static const std::string sql =
        "WITH due AS MATERIALIZED (SELECT ctid FROM waiting WHERE class = 2 AND turn <= " + kClock +
        " ORDER BY turn, seq LIMIT 1000 FOR UPDATE SKIP LOCKED), "
        "taken AS (DELETE FROM waiting WHERE ctid = ANY (ARRAY(SELECT ctid FROM due)) RETURNING *), "
        "flows AS MATERIALIZED (SELECT f.class, f.flow, " +
        last_turn("f.class", "f.flow") +
        " AS turn FROM (SELECT DISTINCT j.class, j.flow FROM taken t JOIN jobs j ON j.seq = t.seq) f), "
        "placed AS (SELECT t.seq, f.turn + row_number() OVER (PARTITION BY j.class, j.flow ORDER BY t.turn, t.seq) AS "
        "turn FROM taken t JOIN jobs j ON j.seq = t.seq JOIN flows f ON f.class = j.class AND f.flow = j.flow), "
        "moved AS (UPDATE jobs j SET turn = p.turn FROM placed p WHERE j.seq = p.seq "
        "RETURNING j.class, j.turn, j.seq), "
        "queued AS (INSERT INTO waiting (class, turn, seq, flow, batch, attempts, crashes, not_before) SELECT m.class, "
        "m.turn, m.seq, t.flow, t.batch, t.attempts, t.crashes, t.not_before FROM moved m JOIN taken t ON t.seq = "
        "m.seq) "
        "SELECT count(*) FROM moved";
    return session.run(sql)[0][0].as<std::size_t>();
}

std::vector<Holding> beat_worker(Session& session, const Heartbeat& beat) {
    session.run("INSERT INTO workers AS w (name, lease_until) VALUES ($1, " + lease_end("$2") +
                    ") ON CONFLICT (name) DO UPDATE SET lease_until = greatest(w.lease_until, EXCLUDED.lease_until)",
                Values().text(beat.worker).number(beat.lease.count()));
    if (!beat.progress.empty()) {
        TextArray seq, attempts, progress;
        for (const ProgressNote& note : beat.progress) {
            seq.add_plain(std::to_string(note.seq));
            attempts.add_plain(std::to_string(note.attempts));
            progress.add(note.progress);
        }
        session.run(
            "UPDATE running r SET progress = g.progress FROM unnest($1::bigint[], $2::int[], $3::text[]) "
            "AS g (seq, attempts, progress) WHERE r.seq = g.seq AND r.attempts = g.attempts AND r.worker = $4",
            Values().plain(seq.literal()).plain(attempts.literal()).plain(progress.literal()).text(beat.worker));
    }
    std::vector<Holding> held;
    for (const pqxx::row& row :
         session.run("SELECT seq, attempts, cancel_requested, started_at FROM running WHERE worker = $1",
                     Values().text(beat.worker)))
        held.push_back({row[0].as<std::int64_t>(), row[1].as<int>(), row[2].as<bool>(), row[3].as<UnixMs>()});
    return held;
}

namespace {

std::string id_of(Session& session, std::int64_t seq) {
    const pqxx::result rows = session.run("SELECT id FROM jobs WHERE seq = $1", Values().number(seq));
    return rows.empty() ? std::string{} : text_of(rows[0][0]);
}

void count(Session& session, const Run& run, JobStatus to, UnixMs now) {
    BatchCounts counts;
    counts.move(run.batch, JobStatus::running, to, 1, has_ended(to) ? now : 0);
    counts.write(session);
}

/// Locked until the end of the transaction; their workers have no sign of life left.
std::vector<std::int64_t> abandoned(Session& session) {
    session.run("DELETE FROM workers WHERE lease_until <= clock_timestamp()");
    std::vector<std::int64_t> found;
    for (const pqxx::row& row :
         session.run("SELECT r.seq FROM running r WHERE NOT EXISTS (SELECT 1 FROM workers w WHERE w.name = r.worker) "
                     "ORDER BY r.seq FOR UPDATE OF r SKIP LOCKED"))
        found.push_back(row[0].as<std::int64_t>());
    return found;
}

}  // namespace

std::optional<Released> release_job(Session& session, std::int64_t seq, int attempts, UnixMs now) {
    const std::optional<RunningRow> row = RunningRow::take(session, seq, attempts);
    if (!row) return std::nullopt;
    const JobStatus status = row->run().unwanted ? JobStatus::cancelled : JobStatus::queued;
    if (row->run().unwanted)
        row->put_ended(session, status, now, "");
    else
        row->put_waiting(session, row->run().crashes);
    count(session, row->run(), status, now);
    return Released{id_of(session, seq), status};
}

std::optional<Recovery> reclaim_jobs(Session& session, const Reclaim& what) {
    const pqxx::result turn = session.run(
        "UPDATE upkeep SET done_at = clock_timestamp() WHERE task = (SELECT task FROM upkeep WHERE task = 'reclaim' "
        "AND (done_at <= clock_timestamp() - $1::bigint * interval '1 millisecond' OR done_at > clock_timestamp()) "
        "FOR UPDATE SKIP LOCKED) RETURNING 1",
        Values().number(what.period.count()));
    if (turn.empty() && what.period.count() > 0) return std::nullopt;
    Recovery recovery;
    for (const std::int64_t seq : abandoned(session)) {
        const std::optional<RunningRow> row = RunningRow::take(session, seq, 0);
        if (!row) continue;
        const int crashes = row->run().crashes + 1;
        const bool tired = crashes >= what.most_attempts;
        JobStatus to = tired ? JobStatus::failed : JobStatus::queued;
        if (row->run().unwanted) to = JobStatus::cancelled;
        if (has_ended(to))
            row->put_ended(session, to, what.now, to == JobStatus::failed ? what.error : "");
        else
            row->put_waiting(session, crashes);
        count(session, row->run(), to, what.now);
        recovery.interrupted += to == JobStatus::queued ? 1U : 0U;
        recovery.given_up += to == JobStatus::failed ? 1U : 0U;
        if (has_ended(to)) recovery.ended.push_back(id_of(session, seq));
    }
    return recovery;
}

}  // namespace tunewright::server::postgres
