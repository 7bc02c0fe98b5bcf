// Single jobs: accepted, ended, cancelled, removed.
#include <map>
#include <set>

#include "server/store/postgres/changes.h"
#include "server/store/postgres/reading.h"
#include "server/store/postgres/text.h"

namespace tunewright::server::postgres {
namespace {

// Served is the turn of the last job that was taken, and at least the one before the first that waits.
const std::string kAccept =
    "WITH given AS MATERIALIZED (SELECT * FROM unnest($1::text[], $2::text[], $3::float8[], $4::text[], $5::text[], "
    "$6::text[], $7::text[], $8::text[], $9::bigint[]) WITH ORDINALITY "
    "AS g (id, name, timeout_s, request, request_hash, key, owner, flow, created_at, place)), "
    "served AS MATERIALIZED (SELECT greatest(0, (SELECT max(turn) FROM jobs WHERE status = 'running' AND class = 0), "
    "(SELECT min(turn) - 1 FROM jobs WHERE status = 'queued' AND class = 0)) AS turn), "
    "flows AS MATERIALIZED (SELECT f.flow, greatest(s.turn, (SELECT max(turn) FROM jobs w WHERE w.status = 'queued' "
    "AND w.class = 0 AND w.flow = f.flow)) AS turn FROM (SELECT DISTINCT flow FROM given) f, served s) "
    "INSERT INTO jobs (id, name, status, class, turn, owner, flow, created_at, timeout_s, request_hash, "
    "idempotency_key, request) SELECT g.id, g.name, 'queued', 0, "
    "f.turn + row_number() OVER (PARTITION BY g.flow ORDER BY g.place), g.owner, g.flow, g.created_at, g.timeout_s, "
    "g.request_hash, nullif(g.key, ''), g.request FROM given g JOIN flows f ON f.flow = g.flow ORDER BY g.place "
    "ON CONFLICT DO NOTHING RETURNING id, seq";

/// The job that stood in the way of this one: that of its key, or itself, accepted before.
Accepted find_earlier(Session& session, const NewJob& job) {
    static const std::string sql = "SELECT " + kSummaryColumns + kTables + " WHERE j.id = $1 UNION ALL SELECT " +
                                   kSummaryColumns + kTables +
                                   " WHERE j.owner = $2 AND j.idempotency_key = $3 AND $3 <> ''";
    const pqxx::result rows = session.run(sql, Values().text(job.id).text(job.owner).text(job.idempotency_key));
    if (rows.empty() || job.idempotency_key.empty())
        throw Failure(Failure::Kind::refused, "a job of that id has been accepted before");
    Accepted accepted;
    accepted.job = read_summary(rows[0]);
    accepted.kind = accepted.job.request_hash == job.request_hash ? Accepted::Kind::existing : Accepted::Kind::conflict;
    return accepted;
}

const std::string kFinish =
    "UPDATE jobs j SET status = g.status, finished_at = g.finished_at, version = g.version, "
    "result = nullif(g.result, ''), error = nullif(g.error, ''), outline = nullif(g.outline, ''), worker = NULL, "
    "lease_until = NULL "
    "FROM unnest($1::text[], $2::int[], $3::text[], $4::text[], $5::text[], $6::text[], $7::bigint[], $8::text[]) "
    "AS g (id, attempts, status, result, error, version, finished_at, outline) "
    "WHERE j.id = g.id AND j.attempts = g.attempts AND j.status = 'running' RETURNING j.id";

struct FoundJob {
    std::int64_t seq = 0;
    JobStatus status = JobStatus::queued;
    bool in_batch = false;
};

/// Held until the end of the transaction.
std::optional<FoundJob> find_job(Session& session, const std::string& id) {
    static const std::string sql =
        "SELECT j.seq, j.status, j.class" + kTables + " WHERE j.id = $1 AND " + kVisible + " FOR UPDATE OF j";
    const pqxx::result rows = session.run(sql, Values().text(id));
    if (rows.empty()) return std::nullopt;
    return FoundJob{rows[0][0].as<std::int64_t>(), job_status(rows[0][1].c_str()).value(), rows[0][2].as<int>() != 0};
}

}  // namespace

std::vector<Accepted> accept_jobs(Session& session, const std::vector<const NewJob*>& jobs) {
    TextArray id, name, timeout, request, hash, key, owner, flow, created;
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
    }
    Values values;
    for (const TextArray* array : {&id, &name, &timeout, &request, &hash, &key, &owner, &flow, &created})
        values.plain(array->literal());
    std::map<std::string, std::int64_t> created_jobs;
    for (const pqxx::row& row : session.run(kAccept, values)) created_jobs[text_of(row[0])] = row[1].as<std::int64_t>();
    std::vector<Accepted> answers;
    for (const NewJob* job : jobs) {
        const auto found = created_jobs.find(job->id);
        if (found == created_jobs.end()) {
            answers.push_back(find_earlier(session, *job));
            continue;
        }
        Accepted& answer = answers.emplace_back();
        answer.job.seq = found->second;
        created_jobs.erase(found);  // the same id once more is not created twice
        answer.job.id = job->id;
        answer.job.name = job->name;
        answer.job.created_at = job->created_at;
        answer.job.timeout_s = job->timeout_s;
        answer.job.request_hash = job->request_hash;
        answer.job.owner = job->owner;
    }
    return answers;
}

std::vector<bool> finish_jobs(Session& session, const std::vector<const JobEnd*>& ends) {
    // In the order of their ids, as every process does: so nobody waits for somebody who waits for him. Of two ends of
    // one job the first counts.
    std::map<std::string, std::size_t> places;
    for (std::size_t i = 0; i < ends.size(); i++) places.emplace(ends[i]->id, i);
    TextArray id, attempts, status, result, error, version, finished, outline;
    for (const auto& [key, place] : places) {
        const JobEnd& end = *ends[place];
        id.add(end.id);
        attempts.add_plain(std::to_string(end.attempts));
        status.add_plain(to_string(end.status));
        result.add(end.result);
        error.add(end.error);
        version.add(end.version);
        finished.add_plain(std::to_string(end.finished_at));
        outline.add(end.outline);
    }
    Values values;
    for (const TextArray* array : {&id, &attempts, &status, &result, &error, &version, &finished, &outline})
        values.plain(array->literal());
    std::vector<bool> answers(ends.size(), false);
    for (const pqxx::row& row : session.run(kFinish, values)) answers[places.at(text_of(row[0]))] = true;
    return answers;
}

CancelEffect cancel_job(Session& session, const std::string& id, UnixMs now) {
    const std::optional<FoundJob> found = find_job(session, id);
    if (!found) return CancelEffect::none;
    if (has_ended(found->status)) return CancelEffect::ended;
    if (found->status == JobStatus::running) {
        session.run("UPDATE jobs SET cancel_requested = true WHERE seq = $1", Values().number(found->seq));
        return CancelEffect::requested;
    }
    session.run("UPDATE jobs SET cancel_requested = true, status = 'cancelled', finished_at = $2 WHERE seq = $1",
                Values().number(found->seq).number(now));
    return CancelEffect::cancelled;
}

RemoveEffect remove_job(Session& session, const std::string& id) {
    const std::optional<FoundJob> found = find_job(session, id);
    if (!found) return RemoveEffect::none;
    if (found->in_batch) return RemoveEffect::in_batch;
    if (!has_ended(found->status)) return RemoveEffect::not_ended;
    session.run("DELETE FROM jobs WHERE seq = $1", Values().number(found->seq));
    return RemoveEffect::removed;
}

}  // namespace tunewright::server::postgres
