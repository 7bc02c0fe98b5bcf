#include "server/store/sqlite/batches.h"

#include <algorithm>

#include "server/store/sqlite/jobs.h"

namespace tunewright::server {
namespace {

struct Receiving {
    std::int64_t seq = 0;
    std::string owner;
    std::string flow;
};

std::optional<Receiving> find_receiving(Connection& store, const std::string& id) {
    Connection::Use row = store.use(
        "SELECT seq, owner, flow FROM batches WHERE id = ?1 AND state = 'receiving' AND NOT cancel_requested");
    if (!row.with(id).next()) return std::nullopt;
    return Receiving{row.integer(0), row.text(1), row.text(2)};
}

void add_entry(Connection& store, const Receiving& batch, const NewEntry& entry, std::int64_t turn, UnixMs now) {
    const bool waits = entry.error.empty();
    {
        Connection::Use row = store.use(
            "INSERT INTO jobs (id, name, status, class, turn, owner, flow, batch, batch_index, created_at, "
            "finished_at, timeout_s, request_hash, outline) "
            "VALUES (?1, ?2, ?3, 1, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, nullif(?13, ''))");
        row.with(entry.id, entry.name, waits ? "queued" : "failed", turn, batch.owner, batch.flow, batch.seq,
                 entry.index, now);
        waits ? row.bind_null(10) : row.bind(10, now);
        row.bind(11, entry.timeout_s);
        row.bind(12, entry.request_hash);
        row.bind(13, entry.outline);
        row.run();
    }
    const std::int64_t seq = store.database().getLastInsertRowid();
    if (!entry.request.empty())
        store.use("INSERT INTO requests (seq, body) VALUES (?1, ?2)").with(seq, entry.request).run();
    if (!waits) store.use("INSERT INTO results (seq, error) VALUES (?1, ?2)").with(seq, entry.error).run();
}

void leave(Connection& store, std::int64_t batch) {
    store.use("UPDATE batches SET state = 'leaving', cancel_from = NULL WHERE seq = ?1").with(batch).run();
    store.use("DELETE FROM batch_keys WHERE batch = ?1").with(batch).run();
}

std::vector<std::int64_t> numbers(Connection::Use& row) {
    std::vector<std::int64_t> found;
    while (row.next()) found.push_back(row.integer(0));
    return found;
}

}  // namespace

void open_batch(Connection& store, const NewBatch& batch) {
    store
        .use(
            "INSERT INTO batches (id, name, owner, flow, created_at, heard_at, state) "
            "VALUES (?1, ?2, ?3, ?4, ?5, ?5, 'receiving')")
        .with(batch.id, batch.name, batch.owner, batch.flow, batch.created_at)
        .run();
}

bool add_entries(Connection& store, const std::string& id, const std::vector<NewEntry>& entries, UnixMs now) {
    const std::optional<Receiving> batch = find_receiving(store, id);
    if (!batch) return false;
    store.use("UPDATE batches SET heard_at = max(heard_at, ?2) WHERE seq = ?1").with(batch->seq, now).run();
    if (entries.empty()) return true;
    std::int64_t turn = next_turn(store, 1, batch->flow);
    for (const NewEntry& entry : entries) {
        add_entry(store, *batch, entry, turn, now);
        if (entry.error.empty()) turn++;
    }
    return true;
}

SealedBatch seal_batch(Connection& store, const BatchSeal& seal) {
    const std::optional<Receiving> batch = find_receiving(store, seal.batch);
    if (!batch) return {};
    if (!seal.idempotency_key.empty()) {
        Connection::Use row = store.use(
            "SELECT b.id, b.request_hash FROM batch_keys k JOIN batches b ON b.seq = k.batch "
            "WHERE k.owner = ?1 AND k.key = ?2");
        if (row.with(batch->owner, seal.idempotency_key).next()) {
            const bool same = row.text(1) == seal.request_hash;
            leave(store, batch->seq);
            return {{same ? Sealed::Kind::existing : Sealed::Kind::conflict, same ? row.text(0) : ""}, batch->seq};
        }
    }
    store
        .use(
            "UPDATE batches SET state = 'sealed', request_hash = ?2, name = coalesce(nullif(?3, ''), name) WHERE seq = "
            "?1")
        .with(batch->seq, seal.request_hash, seal.name)
        .run();
    if (!seal.idempotency_key.empty())
        store.use("INSERT INTO batch_keys (owner, key, batch) VALUES (?1, ?2, ?3)")
            .with(batch->owner, seal.idempotency_key, batch->seq)
            .run();
    return {{Sealed::Kind::sealed, seal.batch}, std::nullopt};
}

std::optional<std::int64_t> leave_batch(Connection& store, const std::string& id) {
    std::int64_t seq = 0;
    {
        Connection::Use row = store.use("SELECT seq FROM batches WHERE id = ?1 AND state <> 'leaving'");
        if (!row.with(id).next()) return std::nullopt;
        seq = row.integer(0);
    }
    leave(store, seq);
    return seq;
}

std::size_t delete_entries(Connection& store, std::int64_t batch, std::size_t most) {
    const int gone = store
                         .use(
                             "DELETE FROM jobs WHERE seq IN (SELECT seq FROM jobs WHERE batch = ?1 "
                             "ORDER BY batch_index LIMIT ?2)")
                         .with(batch, static_cast<std::int64_t>(most))
                         .run();
    if (gone == 0) store.use("DELETE FROM batches WHERE seq = ?1").with(batch).run();
    return static_cast<std::size_t>(gone);
}

RemovedBatch remove_batch(Connection& store, const std::string& id) {
    std::int64_t seq = 0;
    {
        Connection::Use row = store.use(
            "SELECT seq, state = 'sealed' AND queued = 0 AND running = 0 FROM batches "
            "WHERE id = ?1 AND state <> 'leaving'");
        if (!row.with(id).next()) return {};
        if (row.integer(1) == 0) return {RemoveEffect::not_ended, 0};
        seq = row.integer(0);
    }
    leave(store, seq);
    return {RemoveEffect::removed, seq};
}

std::optional<std::int64_t> begin_cancel(Connection& store, const std::string& id) {
    Connection::Use row = store.use(
        "UPDATE batches SET cancel_requested = 1, cancel_from = coalesce(cancel_from, 0) "
        "WHERE id = ?1 AND state <> 'leaving' RETURNING seq");
    if (!row.with(id).next()) return std::nullopt;
    return row.integer(0);
}

bool cancel_entries(Connection& store, std::int64_t batch, UnixMs now) {
    std::int64_t from = 0;
    {
        Connection::Use row = store.use(
            "SELECT cancel_from, (SELECT max(batch_index) FROM jobs WHERE batch = ?1) >= cancel_from FROM batches "
            "WHERE seq = ?1 AND cancel_from IS NOT NULL");
        if (!row.with(batch).next() || row.integer(1) == 0) return false;
        from = row.integer(0);
    }
    const std::int64_t next = from + static_cast<std::int64_t>(kSlice);
    store
        .use(
            "UPDATE jobs SET status = 'cancelled', cancel_requested = 1, finished_at = ?4 "
            "WHERE batch = ?1 AND batch_index >= ?2 AND batch_index < ?3 AND status = 'queued'")
        .with(batch, from, next, now)
        .run();
    store.use("UPDATE batches SET cancel_from = ?2 WHERE seq = ?1").with(batch, next).run();
    return true;
}

std::vector<std::string> end_cancel(Connection& store, std::int64_t batch) {
    store.use("UPDATE batches SET cancel_from = NULL WHERE seq = ?1").with(batch).run();
    Connection::Use row = store.use(
        "UPDATE jobs SET cancel_requested = 1 WHERE class = 1 AND status = 'running' AND batch = ?1 RETURNING id");
    row.with(batch);
    std::vector<std::string> ids;
    while (row.next()) ids.push_back(row.text(0));
    return ids;
}

std::vector<std::int64_t> leave_unheard(Connection& store, UnixMs heard_before) {
    std::vector<std::int64_t> unheard;
    {
        Connection::Use row = store.use(
            "SELECT seq FROM batches WHERE (state <> 'sealed' OR cancel_from IS NOT NULL) AND state = 'receiving' "
            "AND heard_at < ?1");
        unheard = numbers(row.with(heard_before));
    }
    for (const std::int64_t batch : unheard) leave(store, batch);
    Connection::Use row =
        store.use("SELECT seq FROM batches WHERE (state <> 'sealed' OR cancel_from IS NOT NULL) AND state = 'leaving'");
    return numbers(row);
}

std::vector<std::int64_t> being_cancelled(Connection& store) {
    Connection::Use row = store.use("SELECT seq FROM batches WHERE cancel_from IS NOT NULL");
    return numbers(row);
}

std::size_t sweep_slice(Connection& store, UnixMs ended_before, std::size_t most) {
    if (const std::size_t gone = sweep_jobs(store, ended_before, std::min(most, kSlice)); gone > 0) return gone;
    for (;;) {
        std::int64_t batch = 0;
        {
            Connection::Use row = store.use(
                "SELECT seq FROM batches WHERE state = 'leaving' OR (state = 'sealed' AND queued = 0 AND running = 0 "
                "AND max(last_end, created_at) < ?1) ORDER BY state = 'leaving' DESC, seq LIMIT 1");
            if (!row.with(ended_before).next()) return 0;
            batch = row.integer(0);
        }
        leave(store, batch);
        if (const std::size_t gone = delete_entries(store, batch, std::min(most, kSlice)); gone > 0) return gone;
    }
}

}  // namespace tunewright::server
