#include <algorithm>

#include "server/store/postgres/changes.h"
#include "server/store/postgres/reading.h"
#include "server/store/postgres/text.h"

namespace tunewright::server::postgres {
namespace {

std::optional<std::int64_t> one_number(const pqxx::result& rows) {
    if (rows.empty()) return std::nullopt;
    return rows[0][0].as<std::int64_t>();
}

void leave(Session& session, std::int64_t batch) {
    session.run("UPDATE batches SET state = 'leaving', idempotency_key = NULL WHERE seq = $1", Values().number(batch));
}

/// Waiting entries take the turns that follow the last of their flow, as single jobs do among themselves.
const std::string kAdd =
    "WITH served AS MATERIALIZED (SELECT greatest(0, "
    "(SELECT max(turn) FROM jobs WHERE status = 'running' AND class = 1), "
    "(SELECT min(turn) - 1 FROM jobs WHERE status = 'queued' AND class = 1), "
    "(SELECT max(turn) FROM jobs WHERE status = 'queued' AND class = 1 AND flow = $3)) AS turn) "
    "INSERT INTO jobs (id, name, status, class, turn, owner, flow, batch, batch_index, created_at, finished_at, "
    "timeout_s, request_hash, request, error, outline) "
    "SELECT g.id, g.name, CASE WHEN g.error = '' THEN 'queued' ELSE 'failed' END, 1, "
    "s.turn + count(*) FILTER (WHERE g.error = '') OVER (ORDER BY g.index), $2, $3, $1, g.index, $4, "
    "CASE WHEN g.error <> '' THEN $4::bigint END, g.timeout_s, g.request_hash, nullif(g.request, ''), "
    "nullif(g.error, ''), nullif(g.outline, '') "
    "FROM unnest($5::text[], $6::text[], $7::float8[], $8::text[], $9::text[], $10::text[], $11::bigint[], "
    "$12::text[]) "
    "AS g (id, name, timeout_s, request, request_hash, error, index, outline), served s ORDER BY g.index";

}  // namespace

void open_batch(Session& session, const NewBatch& batch) {
    session.run("INSERT INTO batches (id, name, owner, flow, created_at) VALUES ($1, $2, $3, $4, $5)",
                Values().text(batch.id).text(batch.name).text(batch.owner).text(batch.flow).number(batch.created_at));
}

bool add_entries(Session& session, const std::string& id, const std::vector<NewEntry>& entries, UnixMs now) {
    // The row is held until the commit: a cancel or a drop comes before these entries, or after them.
    const pqxx::result rows = session.run(
        "UPDATE batches SET heard_at = clock_timestamp() WHERE id = $1 AND state = 'receiving' "
        "AND NOT cancel_requested RETURNING seq, owner, flow",
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
    session.run(kAdd, values);
    return true;
}

SealedBatch seal_batch(Session& session, const BatchSeal& seal) {
    const pqxx::result rows = session.run(
        "SELECT seq, owner FROM batches WHERE id = $1 AND state = 'receiving' AND NOT cancel_requested "
        "FOR UPDATE",
        Values().text(seal.batch));
    if (rows.empty()) return {};
    const auto seq = rows[0][0].as<std::int64_t>();
    const std::string owner = rows[0][1].c_str();
    if (!seal.idempotency_key.empty()) {
        // Two replicas that seal with one key at the same time come here one after the other.
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
        "name = coalesce(nullif($4, ''), name) "
        "WHERE seq = $1",
        Values().number(seq).text(seal.request_hash).text(seal.idempotency_key).text(seal.name));
    return {{Sealed::Kind::sealed, seal.batch}, std::nullopt};
}

std::optional<std::int64_t> leave_batch(Session& session, const std::string& id) {
    return one_number(
        session.run("UPDATE batches SET state = 'leaving', idempotency_key = NULL "
                    "WHERE id = $1 AND state <> 'leaving' RETURNING seq",
                    Values().text(id)));
}

std::size_t delete_entries(Session& session, std::int64_t batch, std::size_t most) {
    const auto gone = session
                          .run(
                              "DELETE FROM jobs WHERE seq IN (SELECT seq FROM jobs WHERE batch = $1 "
                              "ORDER BY batch_index LIMIT $2)",
                              Values().number(batch).number(static_cast<std::int64_t>(most)))
                          .affected_rows();
    if (gone == 0)
        session.run("DELETE FROM batches WHERE seq = $1 AND NOT EXISTS (SELECT 1 FROM jobs WHERE batch = $1)",
                    Values().number(batch));
    return gone;
}

RemovedBatch remove_batch(Session& session, const std::string& id) {
    static const std::string sql =
        "SELECT " + kBatchColumns + kBatchTables + " WHERE b.id = $1 AND b.state <> 'leaving'" + kBatchGroups;
    const pqxx::result rows = session.run(sql, Values().text(id));
    if (rows.empty()) return {};
    const BatchSummary batch = read_batch(rows[0]);
    if (!batch.ended()) return {RemoveEffect::not_ended, 0};
    leave(session, batch.seq);
    return {RemoveEffect::removed, batch.seq};
}

std::optional<std::int64_t> begin_cancel(Session& session, const std::string& id) {
    return one_number(
        session.run("UPDATE batches SET cancel_requested = true WHERE id = $1 AND state <> 'leaving' RETURNING seq",
                    Values().text(id)));
}

std::optional<std::int64_t> cancel_entries(Session& session, std::int64_t batch, std::int64_t from, UnixMs now) {
    const std::int64_t next = from + static_cast<std::int64_t>(kSlice);
    session.run(
        "UPDATE jobs SET status = 'cancelled', cancel_requested = true, finished_at = $4 "
        "WHERE seq IN (SELECT seq FROM jobs WHERE batch = $1 AND batch_index >= $2 AND batch_index < $3 "
        "AND status = 'queued' FOR UPDATE) AND status = 'queued'",
        Values().number(batch).number(from).number(next).number(now));
    const bool more = session
                          .run("SELECT EXISTS (SELECT 1 FROM jobs WHERE batch = $1 AND batch_index >= $2)",
                               Values().number(batch).number(next))[0][0]
                          .as<bool>();
    return more ? std::optional(next) : std::nullopt;
}

std::vector<std::string> end_cancel(Session& session, std::int64_t batch) {
    std::vector<std::string> ids;
    for (const pqxx::row& row :
         session.run("UPDATE jobs SET cancel_requested = true WHERE class = 1 AND status = 'running' AND batch = $1 "
                     "RETURNING id",
                     Values().number(batch)))
        ids.push_back(text_of(row[0]));
    return ids;
}

Unsettled find_unsettled(Session& session) {
    session.run(
        "UPDATE batches SET state = 'leaving' WHERE (state <> 'sealed' OR cancel_requested) "
        "AND state = 'receiving' AND heard_at < clock_timestamp() - $1::bigint * interval '1 millisecond'",
        Values().number(JobStore::kReceiving.count()));
    Unsettled unsettled;
    for (const pqxx::row& row :
         session.run("SELECT b.seq, b.state = 'leaving' FROM batches b WHERE (b.state <> 'sealed' OR "
                     "b.cancel_requested) AND (b.state = 'leaving' OR (b.cancel_requested AND "
                     "(SELECT sum(c.queued) FROM batch_counts c WHERE c.batch = b.seq) > 0))"))
        (row[1].as<bool>() ? unsettled.leaving : unsettled.cancelling).push_back(row[0].as<std::int64_t>());
    return unsettled;
}

std::size_t sweep_slice(Session& session, const Retention& retention, std::size_t most) {
    const auto slice = static_cast<std::int64_t>(std::min(most, kSlice));
    const UnixMs ended_before =
        one_number(session.run("SELECT least($1, (extract(epoch FROM clock_timestamp()) * 1000)::bigint) - $2",
                               Values().number(retention.now).number(retention.age.count())))
            .value();
    const auto gone = session
                          .run(
                              "DELETE FROM jobs WHERE seq IN (SELECT seq FROM jobs WHERE class = 0 AND "
                              "finished_at IS NOT NULL AND finished_at < $1 ORDER BY finished_at LIMIT $2 "
                              "FOR UPDATE SKIP LOCKED)",
                              Values().number(ended_before).number(slice))
                          .affected_rows();
    if (gone > 0) return gone;
    static const std::string next =
        "SELECT b.seq" + kBatchTables +
        " WHERE b.state <> 'receiving' GROUP BY b.seq HAVING b.state = 'leaving' OR (coalesce(sum(c.queued), 0) = 0 "
        "AND coalesce(sum(c.running), 0) = 0 AND greatest(max(c.last_end), b.created_at) < $1) "
        "ORDER BY b.state = 'leaving' DESC, b.seq LIMIT 1";
    for (;;) {
        const std::optional<std::int64_t> batch = one_number(session.run(next, Values().number(ended_before)));
        if (!batch) return 0;
        leave(session, *batch);
        if (const std::size_t entries = delete_entries(session, *batch, static_cast<std::size_t>(slice)); entries > 0)
            return entries;
    }
}

}  // namespace tunewright::server::postgres
