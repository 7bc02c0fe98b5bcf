#include "server/store/postgres/batch_changes.h"

#include <algorithm>

#include "server/store/postgres/reading.h"
#include "server/store/postgres/text.h"
#include "server/store/postgres/transitions.h"

namespace tunewright::server::postgres {
namespace {

std::optional<std::int64_t> one_number(const pqxx::result& rows) {
    if (rows.empty()) return std::nullopt;
    return rows[0][0].as<std::int64_t>();
}

void leave(Session& session, std::int64_t batch) {
    session.run("UPDATE batches SET state = 'leaving', idempotency_key = NULL, ended_at = NULL WHERE seq = $1",
                Values().number(batch));
}

/// Waiting entries take the turns after the last one of their flow, as single jobs do.
const std::string kAdd =
    "WITH served AS MATERIALIZED (SELECT " + last_turn("1", "$3") +
    " AS turn), "
    "given AS MATERIALIZED (SELECT * FROM unnest($5::text[], $6::text[], $7::float8[], $8::text[], $9::text[], "
    "$10::text[], $11::bigint[], $12::text[]) "
    "AS g (id, name, timeout_s, request, request_hash, error, index, outline)), "
    "made AS (INSERT INTO jobs (id, name, class, turn, owner, flow, batch, batch_index, created_at, timeout_s, "
    "request_hash, request, request_id, traceparent) SELECT g.id, g.name, 1, "
    "s.turn + count(*) FILTER (WHERE g.error = '') OVER (ORDER BY g.index), $2, $3, $1, g.index, $4, g.timeout_s, "
    "g.request_hash, nullif(g.request, ''), $13, $14 FROM given g, served s ORDER BY g.index "
    "RETURNING seq, turn, batch_index), "
    "queued AS (INSERT INTO waiting (class, turn, seq, flow, batch) SELECT 1, m.turn, m.seq, $3, $1 "
    "FROM made m JOIN given g ON g.index = m.batch_index WHERE g.error = '') "
    "INSERT INTO ended (seq, single, status, attempts, cancel_requested, finished_at, error, outline) "
    "SELECT m.seq, false, 'failed', 0, false, $4, g.error, nullif(g.outline, '') "
    "FROM made m JOIN given g ON g.index = m.batch_index WHERE g.error <> ''";

}  // namespace

void open_batch(Session& session, const NewBatch& batch) {
    session.run(
        "INSERT INTO batches (id, name, owner, flow, created_at, notify, request_id, traceparent) "
        "VALUES ($1, $2, $3, $4, $5, nullif($6, ''), $7, $8)",
        Values()
            .text(batch.id)
            .text(batch.name)
            .text(batch.owner)
            .text(batch.flow)
            .number(batch.created_at)
            .text(batch.notify.text())
            .text(batch.origin.request_id)
            .text(batch.origin.traceparent));
}

bool add_entries(Session& session, const std::string& id, const std::vector<NewEntry>& entries, UnixMs now) {
    // The row is locked until the commit: a cancellation or a drop comes before these entries, or after them.
    const pqxx::result rows = session.run(
        "UPDATE batches SET heard_at = clock_timestamp() WHERE id = $1 AND state = 'receiving' "
        "AND NOT cancel_requested RETURNING seq, owner, flow, request_id, traceparent",
        Values().text(id));
    if (rows.empty()) return false;
    if (entries.empty()) return true;
    TextArray ids, name, timeout, request, hash, error, index, outline;
    for (const NewEntry& entry : entries) {
        ids.add(entry.id);
        name.add(entry.name);
        timeout.add_plain(Values().real(entry.timeout_s).list[0]);
        request.add(entry.request);
        hash.add(entry.request_hash);
        error.add(entry.error);
        index.add_plain(std::to_string(entry.index));
        outline.add(entry.outline);
    }
    Values values;
    values.plain(rows[0][0].c_str()).plain(rows[0][1].c_str()).plain(rows[0][2].c_str()).number(now);
    for (const TextArray* array : {&ids, &name, &timeout, &request, &hash, &error, &index, &outline})
        values.plain(array->literal());
    session.run(kAdd, values.plain(rows[0][3].c_str()).plain(rows[0][4].c_str()));
    const auto failed =
        std::count_if(entries.begin(), entries.end(), [](const auto& entry) { return !entry.error.empty(); });
    const auto seq = rows[0][0].as<std::int64_t>();
    BatchCounts counts;
    counts.move(seq, std::nullopt, JobStatus::queued, static_cast<std::int64_t>(entries.size()) - failed);
    counts.move(seq, std::nullopt, JobStatus::failed, failed, now);
    counts.write(session);
    return true;
}

SealedBatch seal_batch(Work& work, const BatchSeal& seal) {
    Session& session = work.session;
    const pqxx::result rows = session.run(
        "SELECT seq, owner FROM batches WHERE id = $1 AND state = 'receiving' AND NOT cancel_requested "
        "FOR UPDATE",
        Values().text(seal.batch));
    if (rows.empty()) return {};
    const auto seq = rows[0][0].as<std::int64_t>();
    const std::string owner = rows[0][1].c_str();
    if (!seal.idempotency_key.empty()) {
        // Serialises replicas that complete batches with the same idempotency key.
        session.run("SELECT pg_advisory_xact_lock(hashtextextended($1 || ' ' || $2, 0))",
                    Values().plain(owner).text(seal.idempotency_key));
        const pqxx::result earlier =
            session.run("SELECT id, request_hash = $3 FROM batches WHERE owner = $1 AND idempotency_key = $2",
                        Values().plain(owner).text(seal.idempotency_key).text(seal.request_hash));
        if (!earlier.empty()) {
            const bool same = earlier[0][1].as<bool>();
            leave(session, seq);
            return {{same ? Sealed::Kind::existing : Sealed::Kind::conflict, same ? text_of(earlier[0][0]) : ""}, seq};
        }
    }
    session.run(
        "UPDATE batches SET state = 'sealed', request_hash = $2, idempotency_key = nullif($3, ''), "
        "name = coalesce(nullif($4, ''), name), notify = coalesce(nullif($5, ''), notify) "
        "WHERE seq = $1",
        Values()
            .number(seq)
            .text(seal.request_hash)
            .text(seal.idempotency_key)
            .text(seal.name)
            .text(seal.notify.text()));
    return {{Sealed::Kind::sealed, seal.batch}, std::nullopt};
}

std::optional<std::int64_t> leave_batch(Work& work, const std::string& id) {
    Session& session = work.session;
    return one_number(
        session.run("UPDATE batches SET state = 'leaving', idempotency_key = NULL, ended_at = NULL "
                    "WHERE id = $1 AND state <> 'leaving' RETURNING seq",
                    Values().text(id)));
}

std::size_t delete_entries(Work& work, std::int64_t batch, std::size_t max) {
    Session& session = work.session;
    // An entry that moves at this moment may stay behind in a table: the last call deletes those.
    const auto gone = session
                          .run(
                              "WITH gone AS (DELETE FROM jobs WHERE seq IN (SELECT seq FROM jobs WHERE batch = $1 "
                              "ORDER BY batch_index LIMIT $2) RETURNING seq, class, turn), "
                              "w AS (DELETE FROM waiting w USING gone g WHERE w.class = g.class AND w.turn = g.turn "
                              "AND w.seq = g.seq), e AS (DELETE FROM ended e USING gone g WHERE e.seq = g.seq), "
                              "r AS (DELETE FROM running r USING gone g WHERE r.seq = g.seq) SELECT seq FROM gone",
                              Values().number(batch).number(static_cast<std::int64_t>(max)))
                          .size();
    if (gone > 0) return static_cast<std::size_t>(gone);
    session.run("DELETE FROM running WHERE batch = $1", Values().number(batch));
    session.run("DELETE FROM batches WHERE seq = $1 AND NOT EXISTS (SELECT 1 FROM jobs WHERE batch = $1)",
                Values().number(batch));
    return 0;
}

RemovedBatch remove_batch(Work& work, const std::string& id) {
    Session& session = work.session;
    static const std::string sql =
        "SELECT " + kBatchColumns + kBatchTables + " WHERE b.id = $1 AND b.state <> 'leaving'" + kBatchGroups;
    const pqxx::result rows = session.run(sql, Values().text(id));
    if (rows.empty()) return {};
    const BatchSummary batch = read_batch(rows[0]);
    if (!batch.ended()) return {RemoveEffect::not_ended, 0};
    leave(session, batch.seq);
    return {RemoveEffect::removed, batch.seq};
}

std::optional<std::int64_t> begin_cancel(Work& work, const std::string& id) {
    Session& session = work.session;
    // A batch that has ended stays as it is: its failed entries may be queued again.
    return one_number(session.run(
        "UPDATE batches b SET cancel_requested = b.cancel_requested OR b.state <> 'sealed' OR "
        "coalesce((SELECT sum(c.queued) + sum(c.running) FROM batch_counts c WHERE c.batch = b.seq), 0) > 0 "
        "WHERE b.id = $1 AND b.state <> 'leaving' RETURNING b.seq",
        Values().text(id)));
}

std::optional<std::int64_t> cancel_entries(Work& work, std::int64_t batch, std::int64_t from, UnixMs now) {
    Session& session = work.session;
    const std::int64_t next = from + static_cast<std::int64_t>(kSliceEntries);
    const auto count =
        session
            .run(
                "WITH taken AS (DELETE FROM waiting w USING jobs j WHERE j.batch = $1 AND j.batch_index >= $2 AND "
                "j.batch_index < $3 AND w.class = j.class AND w.turn = j.turn AND w.seq = j.seq "
                "RETURNING w.seq, w.attempts) "
                "INSERT INTO ended (seq, single, status, attempts, cancel_requested, finished_at) "
                "SELECT seq, false, 'cancelled', attempts, true, $4 FROM taken RETURNING seq",
                Values().number(batch).number(from).number(next).number(now))
            .size();
    BatchCounts counts;
    counts.move(batch, JobStatus::queued, JobStatus::cancelled, count, now);
    counts.write(session);
    const bool more = session
                          .run("SELECT EXISTS (SELECT 1 FROM jobs WHERE batch = $1 AND batch_index >= $2)",
                               Values().number(batch).number(next))[0][0]
                          .as<bool>();
    return more ? std::optional(next) : std::nullopt;
}

std::vector<std::string> end_cancel(Work& work, std::int64_t batch) {
    Session& session = work.session;
    std::vector<std::string> ids;
    for (const pqxx::row& row :
         session.run("UPDATE running r SET cancel_requested = true FROM jobs j WHERE r.batch = $1 AND j.seq = r.seq "
                     "RETURNING j.id",
                     Values().number(batch)))
        ids.push_back(text_of(row[0]));
    for (const std::string& id : ids) work.notices.cancel(id);
    work.notices.ended("");
    return ids;
}

Unsettled settle_batches(Session& session) {
    // The notification of a batch's end is written in the transaction that finds the end.
    static const std::string settle =
        "WITH over AS MATERIALIZED (SELECT b.seq, greatest(b.created_at, (SELECT max(c.last_end) FROM batch_counts c "
        "WHERE c.batch = b.seq)) AS ended_at FROM batches b WHERE b.ended_at IS NULL AND b.state = 'sealed' "
        "AND coalesce((SELECT sum(c.queued) + sum(c.running) FROM batch_counts c WHERE c.batch = b.seq), 0) = 0 "
        "FOR UPDATE OF b SKIP LOCKED), "
        "settled AS (UPDATE batches b SET ended_at = o.ended_at FROM over o WHERE b.seq = o.seq "
        "RETURNING b.id, b.notify, b.ended_at) "
        "INSERT INTO deliveries (target, batch, created_at, due_at) SELECT notify, id, ended_at, ended_at FROM settled "
        "WHERE notify IS NOT NULL";
    session.run(settle);
    session.run(
        "UPDATE batches SET state = 'leaving' WHERE ended_at IS NULL AND state = 'receiving' "
        "AND heard_at < clock_timestamp() - $1::bigint * interval '1 millisecond'",
        Values().number(BatchStore::kReceiving.count()));
    Unsettled unsettled;
    for (const pqxx::row& row :
         session.run("SELECT b.seq, b.state = 'leaving' FROM batches b WHERE b.ended_at IS NULL AND "
                     "(b.state = 'leaving' OR (b.cancel_requested AND "
                     "(SELECT sum(c.queued) FROM batch_counts c WHERE c.batch = b.seq) > 0))"))
        (row[1].as<bool>() ? unsettled.leaving : unsettled.cancelling).push_back(row[0].as<std::int64_t>());
    return unsettled;
}

namespace {

std::size_t sweep_state(Session& session, JobStatus status, UnixMs ended_before, std::size_t max) {
    const pqxx::result gone = session.run(
        "WITH due AS MATERIALIZED (SELECT seq FROM ended WHERE single AND status = $1 AND finished_at < $2 "
        "ORDER BY finished_at LIMIT $3), "
        // A batch with a job that is queued again is not among those that have ended, and stays.
        "gone AS (DELETE FROM ended WHERE seq IN (SELECT seq FROM due) RETURNING seq) "
        "DELETE FROM jobs WHERE seq IN (SELECT seq FROM gone) RETURNING seq",
        Values().plain(std::string(to_string(status))).number(ended_before).number(static_cast<std::int64_t>(max)));
    return static_cast<std::size_t>(gone.size());
}

/// False if a job of the batch is queued again.
bool leave_if_over(Session& session, std::int64_t batch, UnixMs ended_before) {
    const Values values = std::move(Values().number(batch).number(ended_before));
    const pqxx::result over =
        session.run("SELECT 1 FROM batches WHERE seq = $1 AND (state = 'leaving' OR ended_at < $2) FOR UPDATE", values);
    if (over.empty()) return false;
    leave(session, batch);
    return true;
}

std::size_t sweep_batch(Work& work, UnixMs ended_before, std::size_t max) {
    settle_batches(work.session);
    for (;;) {
        const std::optional<std::int64_t> batch = one_number(work.session.run(
            "SELECT seq FROM batches WHERE ended_at IS NULL AND state = 'leaving' UNION ALL "
            "(SELECT seq FROM batches WHERE ended_at IS NOT NULL AND ended_at < $1 ORDER BY ended_at LIMIT 1) LIMIT 1",
            Values().number(ended_before)));
        if (!batch) return 0;
        if (!leave_if_over(work.session, *batch, ended_before)) continue;
        if (const std::size_t gone = delete_entries(work, *batch, max); gone > 0) return gone;
    }
}

}  // namespace

std::size_t sweep_slice(Work& work, UnixMs now, const Retention& retention, std::size_t max) {
    const std::size_t slice = std::min(max, kSliceEntries);
    const pqxx::row row = work.session.run(
        "SELECT least($1, (extract(epoch FROM clock_timestamp()) * 1000)::bigint), "
        "pg_try_advisory_xact_lock(x'74756e6577737765'::bigint)",  // "tunewswe": one process sweeps at a time
        Values().number(now))[0];
    if (!row[1].as<bool>()) return 0;
    const auto earlier = row[0].as<UnixMs>();
    for (const auto& [status, age] : retention.by_state())
        if (age)
            if (const std::size_t gone = sweep_state(work.session, status, earlier - age->count(), slice); gone > 0)
                return gone;
    const auto longest = retention.longest();
    return longest ? sweep_batch(work, earlier - longest->count(), slice) : 0;
}

}  // namespace tunewright::server::postgres
