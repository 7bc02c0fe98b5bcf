#include "server/store/postgres/job_changes.h"

#include <algorithm>
#include <map>
#include <set>

#include "server/store/postgres/reading.h"
#include "server/store/postgres/text.h"
#include "server/store/postgres/transitions.h"

namespace tunewright::server::postgres {

namespace {

/// With a limit ($15) the statement is another one: a common one would be planned again each time.
std::string accept_sql(bool limited) {
    const auto if_limited = [limited](const std::string& sql) { return limited ? sql : std::string(); };
    return "WITH given AS MATERIALIZED (SELECT g.*, CASE WHEN g.earliest > " + kClock +
           " THEN g.earliest END AS not_before" +
           // A job that exists already, or occurs twice, is not inserted and does not count.
           if_limited(
               ", g.key <> '' AND (row_number() OVER (PARTITION BY g.owner, g.key ORDER BY g.place) > 1 OR "
               "(SELECT j.seq FROM jobs j WHERE j.owner = g.owner AND j.idempotency_key = g.key) IS NOT NULL) "
               "AS repeated") +
           " FROM unnest($1::text[], $2::text[], $3::float8[], $4::text[], $5::text[], $6::text[], $7::text[], "
           "$8::text[], $9::bigint[], $10::smallint[], $11::text[], $12::text[], $13::text[], $14::bigint[]) "
           "WITH ORDINALITY AS g (id, name, timeout_s, request, request_hash, key, owner, flow, created_at, class, "
           "notify, request_id, traceparent, earliest, place)), "
           "flows AS MATERIALIZED (SELECT f.flow, f.class, " +
           last_turn("f.class", "f.flow") + " AS turn" + if_limited(", " + under_way("f.flow") + " AS under_way") +
           " FROM (SELECT DISTINCT flow, class FROM given) f), "
           "placed AS (SELECT g.*, coalesce(g.not_before, "
           "f.turn + row_number() OVER (PARTITION BY g.flow, g.class ORDER BY g.place)) AS turn" +
           if_limited(
               ", f.under_way + count(*) FILTER (WHERE NOT g.repeated) "
               "OVER (PARTITION BY g.flow ORDER BY g.place) AS under_way") +
           " FROM given g JOIN flows f ON f.flow = g.flow AND f.class = g.class), "
           "made AS (INSERT INTO jobs (id, name, class, turn, owner, flow, created_at, timeout_s, request_hash, "
           "idempotency_key, request, notify, request_id, traceparent, not_before) SELECT id, name, class, turn, "
           "owner, flow, created_at, timeout_s, request_hash, nullif(key, ''), request, nullif(notify, ''), "
           "request_id, traceparent, not_before FROM placed " +
           if_limited("WHERE under_way <= $15 ") +
           // By key, in the same order in every process: two that insert the same keys wait for each other in one
           // direction.
           "ORDER BY owner COLLATE \"C\", key COLLATE \"C\", place ON CONFLICT DO NOTHING "
           "RETURNING id, seq, class, turn, flow, not_before), "
           "queued AS (INSERT INTO waiting (class, turn, seq, flow) "
           "SELECT CASE WHEN not_before IS NULL THEN class ELSE 2 END, turn, seq, flow FROM made) "
           "SELECT id, seq, not_before FROM made";
}

/// A job that failed or was cancelled gives its key up to a unique one, and keeps it behind its id. The caller has
/// taken the lock of that key (take_turns): a job that is queued again takes the same lock first.
void free_key(Session& session, const std::string& owner, const std::string& key) {
    session.run(
        "WITH free AS MATERIALIZED (SELECT e.seq FROM jobs j JOIN ended e ON e.seq = j.seq WHERE j.owner = $1 "
        "AND j.idempotency_key = $2 AND e.status IN ('failed', 'cancelled') FOR UPDATE OF e) "
        "UPDATE jobs SET idempotency_key = ' ' || id || idempotency_key WHERE seq IN (SELECT seq FROM free)",
        Values().text(owner).text(key));
}

/// A job that has given its key up takes it back; false if a later job has it. Until the commit no other job is
/// accepted with that key, given up or not: take_turns holds its lock.
bool take_key_back(Session& session, std::int64_t seq) {
    static const std::string look =
        "SELECT owner, substr(idempotency_key, 2 + length(id)) FROM jobs "
        "WHERE seq = $1 AND starts_with(idempotency_key, ' ' || id)";
    const pqxx::result given_up = session.run(look, Values().number(seq));
    if (given_up.empty()) return true;
    const std::string owner = text_of(given_up[0][0]), key = text_of(given_up[0][1]);
    free_key(session, owner, key);
    return session
               .run(
                   "UPDATE jobs SET idempotency_key = $3 WHERE seq = $1 AND NOT EXISTS "
                   "(SELECT 1 FROM jobs WHERE owner = $2 AND idempotency_key = $3)",
                   Values().number(seq).text(owner).text(key))
               .affected_rows() > 0;
}

/// The job that prevented this one: the job with its key, or the same job if it was accepted before.
Accepted find_earlier(Session& session, const NewJob& job) {
    static const std::string sql = "SELECT " + kSummaryColumns + kJobTables + " WHERE j.id = $1 UNION ALL SELECT " +
                                   kSummaryColumns + kJobTables +
                                   " WHERE j.owner = $2 AND j.idempotency_key = $3 AND $3 <> ''";
    const pqxx::result rows = session.run(sql, Values().text(job.id).text(job.owner).text(job.idempotency_key));
    if (rows.empty() && job.client_limit > 0) return {Accepted::Kind::too_many, {}};
    if (rows.empty() || job.idempotency_key.empty())
        throw Failure(Failure::Kind::refused, "a job of that id has been accepted before");
    Accepted accepted;
    accepted.job = read_summary(rows[0]);
    accepted.kind = accepted.job.request_hash == job.request_hash ? Accepted::Kind::existing : Accepted::Kind::conflict;
    return accepted;
}

// Results are long. They are read in a separate statement, for the jobs that are to be written, concatenated in one
// piece of bytes: an array of them would be parsed character by character.
const std::string kTake =
    "DELETE FROM running r USING unnest($1::bigint[], $2::int[]) AS g (seq, attempts) WHERE r.seq = g.seq "
    "AND r.attempts = g.attempts RETURNING r.seq, r.batch, r.started_at, r.cancel_requested, "
    // An entry whose batch is being deleted at this moment is not ended.
    "r.batch IS NULL OR EXISTS (SELECT 1 FROM jobs j WHERE j.seq = r.seq)";
const std::string kEnd =
    "WITH gone AS (INSERT INTO ended (seq, single, status, attempts, cancel_requested, started_at, finished_at, "
    "version, outline, error, result) SELECT g.seq, g.single, g.status, g.attempts, g.cancel_requested, g.started_at, "
    "g.finished_at, g.version, nullif(g.outline, ''), nullif(g.error, ''), "
    "CASE WHEN g.length > 0 THEN convert_from(substring($13::bytea FROM g.first FOR g.length), 'UTF8') END "
    "FROM unnest($1::bigint[], $2::boolean[], $3::text[], $4::int[], $5::boolean[], $6::bigint[], $7::bigint[], "
    "$8::text[], $9::text[], $10::text[], $11::int[], $12::int[]) AS g (seq, single, status, attempts, "
    "cancel_requested, started_at, finished_at, version, outline, error, first, length) RETURNING seq, finished_at) " +
    insert_deliveries("gone", "s.finished_at");

struct FoundJob {
    std::int64_t seq = 0;
    std::optional<std::int64_t> batch;
    bool batch_cancelled = false;
    bool readable = false;  ///< has a request
};

/// A job in any state, unless its batch is being deleted.
std::optional<FoundJob> find_job(Session& session, const std::string& id) {
    const pqxx::result rows = session.run(
        "SELECT j.seq, j.batch, coalesce(b.cancel_requested, false), j.request IS NOT NULL FROM jobs j "
        "LEFT JOIN batches b ON b.seq = j.batch WHERE j.id = $1 AND (j.batch IS NULL OR b.state <> 'leaving')",
        Values().text(id));
    if (rows.empty()) return std::nullopt;
    FoundJob found;
    found.seq = rows[0][0].as<std::int64_t>();
    if (!rows[0][1].is_null()) found.batch = rows[0][1].as<std::int64_t>();
    found.batch_cancelled = rows[0][2].as<bool>();
    found.readable = rows[0][3].as<bool>();
    return found;
}

/// False if it does not wait at this moment.
bool cancel_waiting(Session& session, std::int64_t seq, UnixMs now) {
    static const std::string sql =
        "WITH taken AS (DELETE FROM waiting w USING jobs j WHERE j.seq = $1 AND w.class IN (j.class, 2) AND "
        "w.turn = j.turn AND w.seq = j.seq RETURNING w.seq, w.batch, w.attempts), "
        "gone AS (INSERT INTO ended (seq, single, status, attempts, cancel_requested, finished_at) "
        "SELECT seq, batch IS NULL, 'cancelled', attempts, true, $2 FROM taken RETURNING seq), counted AS (" +
        insert_deliveries("gone", "$2") + ") SELECT seq FROM taken";
    return !session.run(sql, Values().number(seq).number(now)).empty();
}

bool has_ended(Session& session, std::int64_t seq) {
    return !session.run("SELECT 1 FROM ended WHERE seq = $1", Values().number(seq)).empty();
}

bool has_failed(Session& session, std::int64_t seq) {
    return !session
                .run("SELECT 1 FROM ended WHERE seq = $1 AND status IN ('failed', 'cancelled')", Values().number(seq))
                .empty();
}

constexpr int kMaxCancelTries = 20;  // attempts for a job that others move meanwhile

}  // namespace

void take_turns(Session& session, const std::vector<const NewJob*>& accepted,
                const std::vector<std::string>& requeued) {
    static const std::string names_of_requeued =
        "SELECT unnest(ARRAY[j.id, 'batch ' || j.batch, CASE WHEN starts_with(j.idempotency_key, ' ' || j.id) "
        "THEN substr(j.idempotency_key, 2 + length(j.id)) ELSE j.idempotency_key END]) "
        "FROM jobs j WHERE j.id = ANY ($1::text[])";
    static const std::string lock =
        "SELECT count(pg_advisory_xact_lock(x'74756e65'::int, hash)) FROM "
        "(SELECT DISTINCT hashtext(name) AS hash FROM unnest($1::text[]) AS g (name) ORDER BY hash OFFSET 0) f";
    TextArray names, ids;
    for (const NewJob* job : accepted) {
        if (job->client_limit > 0) names.add(job->flow);
        if (job->unique) names.add(job->idempotency_key);
    }
    for (const std::string& id : requeued) ids.add(id);
    if (!requeued.empty())
        for (const pqxx::row& row : session.run(names_of_requeued, Values().plain(ids.literal())))
            if (!row[0].is_null()) names.add(text_of(row[0]));
    if (names.literal() != "{}") session.run(lock, Values().plain(names.literal()));
}

std::vector<Accepted> accept_jobs(Session& session, const std::vector<const NewJob*>& jobs) {
    TextArray id, name, timeout, request, hash, key, owner, flow, created, priority, notify, call, trace, not_before;
    const std::size_t client_limit = jobs.front()->client_limit;  // the same for all jobs of a process
    for (const NewJob* job : jobs) {
        id.add(job->id);
        name.add(job->name);
        timeout.add_plain(Values().real(job->timeout_s).list[0]);
        request.add(job->request);
        hash.add(job->request_hash);
        key.add(job->idempotency_key);
        owner.add(job->owner);
        flow.add(job->flow);
        created.add_plain(std::to_string(job->created_at));
        priority.add_plain(std::to_string(static_cast<int>(job->priority)));
        notify.add(job->notify.text());
        call.add(job->origin.request_id);
        trace.add(job->origin.traceparent);
        not_before.add_plain(std::to_string(job->not_before.value_or(0)));
    }
    for (const NewJob* job : jobs)
        if (job->unique) free_key(session, job->owner, job->idempotency_key);
    Values values;
    for (const TextArray* array : {&id, &name, &timeout, &request, &hash, &key, &owner, &flow, &created, &priority,
                                   &notify, &call, &trace, &not_before})
        values.plain(array->literal());
    if (client_limit > 0) values.number(static_cast<std::int64_t>(client_limit));
    static const std::string plain = accept_sql(false), limited = accept_sql(true);
    const pqxx::result made = session.run(client_limit > 0 ? limited : plain, values);
    std::map<std::string, pqxx::row> created_jobs;
    for (const pqxx::row& row : made) created_jobs[text_of(row[0])] = row;
    std::vector<Accepted> answers;
    for (const NewJob* job : jobs) {
        const auto found = created_jobs.find(job->id);
        if (found == created_jobs.end()) {
            answers.push_back(find_earlier(session, *job));
            continue;
        }
        Accepted& answer = answers.emplace_back(Accepted::Kind::created, summary_of(*job));
        answer.job.seq = found->second[1].as<std::int64_t>();
        answer.job.not_before = moment(found->second[2]);
        created_jobs.erase(found);  // a repeated id is not created twice
    }
    return answers;
}

std::vector<bool> finish_jobs(Session& session, const std::vector<const JobEnd*>& ends) {
    // If one job has two ends, the first counts.
    std::map<std::int64_t, std::size_t> places;
    for (std::size_t i = 0; i < ends.size(); i++) places.emplace(ends[i]->seq, i);
    TextArray wanted, tokens;
    for (const auto& [seq, place] : places) {
        wanted.add_plain(std::to_string(seq));
        tokens.add_plain(std::to_string(ends[place]->attempts));
    }
    std::vector<bool> answers(ends.size(), false);
    BatchCounts counts;
    TextArray seq, single, status, attempts, cancel, started, finished, version, outline, error, first, length;
    std::string results;
    for (const pqxx::row& row : session.run(kTake, Values().plain(wanted.literal()).plain(tokens.literal()))) {
        if (!row[4].as<bool>()) continue;
        const std::size_t place = places.at(row[0].as<std::int64_t>());
        const JobEnd& end = *ends[place];
        answers[place] = true;
        if (!row[1].is_null())
            counts.move(row[1].as<std::int64_t>(), JobStatus::running, end.status, 1, end.finished_at);
        seq.add_plain(std::to_string(end.seq));
        single.add_plain(row[1].is_null() ? "t" : "f");
        status.add_plain(to_string(end.status));
        attempts.add_plain(std::to_string(end.attempts));
        cancel.add_plain(row[3].c_str());
        started.add_plain(row[2].c_str());
        finished.add_plain(std::to_string(end.finished_at));
        version.add(end.version);
        outline.add(end.outline);
        error.add(end.error);
        const std::string result = to_column(end.result);
        first.add_plain(std::to_string(results.size() + 1));
        length.add_plain(std::to_string(result.size()));
        results.append(result);
    }
    if (std::find(answers.begin(), answers.end(), true) == answers.end()) return answers;
    Values values;
    for (const TextArray* array :
         {&seq, &single, &status, &attempts, &cancel, &started, &finished, &version, &outline, &error, &first, &length})
        values.plain(array->literal());
    session.run(kEnd, values, &results);
    counts.write(session);
    return answers;
}

CancelEffect cancel_job(Session& session, const std::string& id, UnixMs now) {
    const std::optional<FoundJob> found = find_job(session, id);
    if (!found) return CancelEffect::none;
    // Other processes may move it between two attempts: from waiting to running and back.
    for (int tries = 0; tries < kMaxCancelTries; tries++) {
        if (cancel_waiting(session, found->seq, now)) {
            BatchCounts counts;
            counts.move(found->batch, JobStatus::queued, JobStatus::cancelled, 1, now);
            counts.write(session);
            return CancelEffect::cancelled;
        }
        if (session.run("UPDATE running SET cancel_requested = true WHERE seq = $1", Values().number(found->seq))
                .affected_rows() > 0)
            return CancelEffect::requested;
        if (has_ended(session, found->seq)) return CancelEffect::ended;
    }
    throw Failure(Failure::Kind::conflict, "the job changed its state too often to be cancelled");
}

RequeueEffect requeue_job(Session& session, const std::string& id) {
    const std::optional<FoundJob> found = find_job(session, id);
    if (!found) return RequeueEffect::none;
    // A request that could not be read cannot be computed either.
    if (!found->readable || !has_failed(session, found->seq)) return RequeueEffect::not_failed;
    if (found->batch_cancelled) return RequeueEffect::batch_cancelled;
    // Locked until the commit, so that it is not swept meanwhile; an earlier sweep wins.
    if (found->batch && session
                            .run("SELECT 1 FROM batches WHERE seq = $1 AND state <> 'leaving' FOR UPDATE",
                                 Values().number(*found->batch))
                            .empty())
        return RequeueEffect::none;
    if (!take_key_back(session, found->seq)) return RequeueEffect::superseded;
    static const std::string sql =
        "WITH gone AS (DELETE FROM ended WHERE seq = $1 AND status IN ('failed', 'cancelled') "
        "RETURNING seq, status, attempts), "
        "placed AS (UPDATE jobs j SET turn = CASE WHEN gone.attempts = 0 AND j.not_before > " +
        kClock + " THEN j.not_before ELSE 1 + " + last_turn("j.class", "j.flow") +
        " END FROM gone WHERE j.seq = gone.seq "
        "RETURNING CASE WHEN j.turn = j.not_before THEN 2 ELSE j.class END AS class, j.turn, j.seq, j.flow, j.batch), "
        "queued AS (INSERT INTO waiting (class, turn, seq, flow, batch, attempts) SELECT p.class, p.turn, p.seq, "
        "p.flow, p.batch, gone.attempts FROM placed p JOIN gone ON gone.seq = p.seq) SELECT status FROM gone";
    const pqxx::result rows = session.run(sql, Values().number(found->seq));
    if (rows.empty()) return RequeueEffect::not_failed;
    if (found->batch) {
        BatchCounts counts;
        counts.move(found->batch, job_status(rows[0][0].c_str()), JobStatus::queued);
        counts.write(session);
        session.run("UPDATE batches SET ended_at = NULL WHERE seq = $1", Values().number(*found->batch));
    }
    return RequeueEffect::requeued;
}

RemoveEffect remove_job(Session& session, const std::string& id) {
    const std::optional<FoundJob> found = find_job(session, id);
    if (!found) return RemoveEffect::none;
    if (found->batch) return RemoveEffect::in_batch;
    if (session.run("DELETE FROM ended WHERE seq = $1", Values().number(found->seq)).affected_rows() == 0)
        return RemoveEffect::not_ended;
    session.run("DELETE FROM jobs WHERE seq = $1", Values().number(found->seq));
    return RemoveEffect::removed;
}

namespace {

/// The end of a lease: now plus the milliseconds of parameter `place`.
std::string lease_end(const std::string& place) {
    return "clock_timestamp() + " + place + "::bigint * interval '1 millisecond'";
}

/// Claims the waiting jobs that `which` selects.
std::string claim_sql(const std::string& which) {
    return "WITH next AS MATERIALIZED (SELECT ctid FROM waiting WHERE " + which +
           " LIMIT $1 FOR UPDATE SKIP LOCKED), "
           "taken AS (DELETE FROM waiting WHERE ctid = ANY (ARRAY(SELECT ctid FROM next)) RETURNING *), "
           "runs AS (INSERT INTO running (seq, class, turn, flow, batch, worker, attempts, crashes, started_at) "
           "SELECT seq, class, turn, flow, batch, $2, attempts + 1, crashes, $3 FROM taken "
           "RETURNING seq, class, turn, attempts, batch, started_at), "
           // A heartbeat, if the last one is too old.
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
                              .number(static_cast<std::int64_t>(claim.max))
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

void count(Session& session, const RunningJob& run, JobStatus to, UnixMs now) {
    BatchCounts counts;
    counts.move(run.batch, JobStatus::running, to, 1, has_ended(to) ? now : 0);
    counts.write(session);
}

/// Running jobs whose workers have no valid lease, locked until the end of the transaction.
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
        const bool tired = crashes >= what.max_attempts;
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

std::vector<Delivery> take_deliveries(Session& session, UnixMs now, std::chrono::milliseconds hold, std::size_t max) {
    const pqxx::result rows = session.run(
        "WITH due AS MATERIALIZED (SELECT seq, due_at FROM deliveries WHERE due_at <= $1 ORDER BY due_at LIMIT $3 "
        "FOR UPDATE SKIP LOCKED), held AS (UPDATE deliveries d SET due_at = $2 FROM due WHERE d.seq = due.seq "
        "RETURNING d.seq, d.target, d.job, d.batch, d.tries, d.created_at, due.due_at AS was) "
        "SELECT seq, target, job, batch, tries, created_at FROM held ORDER BY was, seq",
        Values().number(now).number(now + hold.count()).number(static_cast<std::int64_t>(max)));
    std::vector<Delivery> due;
    for (const pqxx::row& row : rows)
        due.push_back({row[0].as<std::int64_t>(), NotifyTarget::of_text(text_of(row[1])), text_of(row[2]),
                       text_of(row[3]), row[4].as<int>(), row[5].as<UnixMs>()});
    return due;
}

bool settle_delivery(Session& session, std::int64_t seq, UnixMs now, std::optional<std::chrono::milliseconds> pause,
                     bool tried) {
    if (!pause) return session.run("DELETE FROM deliveries WHERE seq = $1", Values().number(seq)).affected_rows() > 0;
    return session
               .run("UPDATE deliveries SET tries = tries + $3, due_at = $2 WHERE seq = $1",
                    Values().number(seq).number(now + pause->count()).number(tried ? 1 : 0))
               .affected_rows() > 0;
}

bool pause_queue(Session& session, bool paused) {
    session.run("INSERT INTO settings (name, value) VALUES ('paused', $1) ON CONFLICT (name) DO UPDATE SET value = $1",
                Values().plain(paused ? "1" : "0"));
    return true;
}

}  // namespace tunewright::server::postgres
