#include "server/store/sqlite/batch_changes.h"

#include <algorithm>

#include "server/store/sqlite/transitions.h"

namespace tunewright::server {
namespace {

struct Receiving {
    std::int64_t seq = 0;
    std::string owner;
    std::string flow;
    std::string request_id;
    std::string traceparent;
};

std::optional<Receiving> find_receiving(Connection& store, const std::string& id) {
    Connection::Use row = store.use(
        "SELECT seq, owner, flow, request_id, traceparent FROM batches "
        "WHERE id = ?1 AND state = 'receiving' AND NOT cancel_requested");
    if (!row.with(id).next()) return std::nullopt;
    return Receiving{row.integer(0), row.text(1), row.text(2), row.text(3), row.text(4)};
}

void add_entry(Connection& store, const Receiving& batch, const NewEntry& entry, std::int64_t turn, UnixMs now) {
    constexpr int kLow = static_cast<int>(Priority::low);
    store
        .use(
            "INSERT INTO jobs (id, name, owner, flow, class, turn, batch, batch_index, created_at, timeout_s, "
            "request_hash, request_id, traceparent, request) "
            "VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, ?9, ?10, ?11, ?12, ?13, nullif(?14, ''))")
        .with(entry.id, entry.name, batch.owner, batch.flow, kLow, turn, batch.seq, entry.index, now, entry.timeout_s,
              entry.request_hash, batch.request_id, batch.traceparent, entry.request)
        .run();
    const RowPosition place{store.database().getLastInsertRowid(), kLow, turn, batch.flow, batch.seq, 0, 0};
    if (entry.error.empty()) return put_waiting(store, place);
    Ending ending = Ending::failed(now, entry.error);
    put_ended(store, place, std::nullopt,
              {ending.status, now, false, ending.version, entry.outline, entry.error, ending.result});
}

void leave(Connection& store, std::int64_t batch) {
    store.use("UPDATE batches SET state = 'leaving', idempotency_key = NULL, ended_at = NULL WHERE seq = ?1")
        .with(batch)
        .run();
}

std::vector<std::int64_t> numbers(Connection::Use& row) {
    std::vector<std::int64_t> found;
    while (row.next()) found.push_back(row.integer(0));
    return found;
}

}  // namespace

void open_batch(Connection& store, const NewBatch& batch) {
    const std::string target = batch.notify.text();
    store
        .use(
            "INSERT INTO batches (id, name, owner, flow, created_at, heard_at, state, notify, request_id, traceparent) "
            "VALUES (?1, ?2, ?3, ?4, ?5, ?5, 'receiving', nullif(?6, ''), ?7, ?8)")
        .with(batch.id, batch.name, batch.owner, batch.flow, batch.created_at, target, batch.origin.request_id,
              batch.origin.traceparent)
        .run();
}

bool add_entries(Connection& store, const std::string& id, const std::vector<NewEntry>& entries, UnixMs now) {
    const std::optional<Receiving> batch = find_receiving(store, id);
    if (!batch) return false;
    store.use("UPDATE batches SET heard_at = max(heard_at, ?2) WHERE seq = ?1").with(batch->seq, now).run();
    if (entries.empty()) return true;
    std::int64_t turn = next_turn(store, static_cast<int>(Priority::low), batch->flow);
    BatchCounts counts;
    for (const NewEntry& entry : entries) {
        const bool waits = entry.error.empty();
        add_entry(store, *batch, entry, turn, now);
        if (waits) turn++;
        counts.move(batch->seq, std::nullopt, waits ? JobStatus::queued : JobStatus::failed, waits ? 0 : now);
    }
    counts.write(store);
    return true;
}

SealedBatch seal_batch(Connection& store, const BatchSeal& seal) {
    const std::optional<Receiving> batch = find_receiving(store, seal.batch);
    if (!batch) return {};
    if (!seal.idempotency_key.empty()) {
        Connection::Use row =
            store.use("SELECT id, request_hash FROM batches WHERE owner = ?1 AND idempotency_key = ?2");
        if (row.with(batch->owner, seal.idempotency_key).next()) {
            const bool same = row.text(1) == seal.request_hash;
            leave(store, batch->seq);
            return {{same ? Sealed::Kind::existing : Sealed::Kind::conflict, same ? row.text(0) : ""}, batch->seq};
        }
    }
    const std::string target = seal.notify.text();
    store
        .use(
            "UPDATE batches SET state = 'sealed', request_hash = ?2, name = coalesce(nullif(?3, ''), name), "
            "idempotency_key = nullif(?4, ''), notify = coalesce(nullif(?5, ''), notify) WHERE seq = ?1")
        .with(batch->seq, seal.request_hash, seal.name, seal.idempotency_key, target)
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

std::size_t delete_entries(Connection& store, std::int64_t batch, std::size_t max) {
    std::vector<RowPosition> places;
    {
        Connection::Use row = store.use(
            "SELECT seq, class, turn, '', batch, 0, 0 FROM jobs WHERE batch = ?1 ORDER BY batch_index LIMIT ?2");
        row.with(batch, static_cast<std::int64_t>(max));
        while (row.next()) places.push_back(read_place(row));
    }
    for (const RowPosition& place : places) {
        if (!take_waiting(store, place) && store.use("DELETE FROM ended WHERE seq = ?1").with(place.seq).run() == 0)
            take_running(store, place.seq, std::nullopt);
        store.use("DELETE FROM jobs WHERE seq = ?1").with(place.seq).run();
    }
    if (places.empty()) store.use("DELETE FROM batches WHERE seq = ?1").with(batch).run();
    return places.size();
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
    // A batch that has ended stays as it is: its failed entries may be queued again.
    Connection::Use row = store.use(
        "UPDATE batches SET cancel_requested = cancel_requested OR state <> 'sealed' OR queued > 0 OR running > 0 "
        "WHERE id = ?1 AND state <> 'leaving' RETURNING seq");
    if (!row.with(id).next()) return std::nullopt;
    return row.integer(0);
}

std::optional<std::int64_t> cancel_entries(Connection& store, std::int64_t batch, std::int64_t from, UnixMs now) {
    const std::int64_t next = from + static_cast<std::int64_t>(kSliceEntries);
    std::vector<RowPosition> places;
    {
        Connection::Use row = store.use(
            "SELECT w.seq, w.class, w.turn, w.flow, w.batch, w.attempts, w.crashes FROM jobs j "
            "JOIN waiting w ON w.class = j.class AND w.turn = j.turn AND w.seq = j.seq "
            "WHERE j.batch = ?1 AND j.batch_index >= ?2 AND j.batch_index < ?3");
        row.with(batch, from, next);
        while (row.next()) places.push_back(read_place(row));
    }
    BatchCounts counts;
    for (const RowPosition& place : places) {
        take_waiting(store, place);
        put_ended(store, place, std::nullopt, Ending::cancelled(now));
        counts.move(batch, JobStatus::queued, JobStatus::cancelled, now);
    }
    counts.write(store);
    Connection::Use more = store.use("SELECT EXISTS (SELECT 1 FROM jobs WHERE batch = ?1 AND batch_index >= ?2)");
    return more.with(batch, next).next() && more.integer(0) != 0 ? std::optional(next) : std::nullopt;
}

std::vector<std::string> end_cancel(Connection& store, std::int64_t batch) {
    store.use("UPDATE running SET cancel_requested = 1 WHERE batch = ?1").with(batch).run();
    Connection::Use row = store.use("SELECT j.id FROM running r JOIN jobs j ON j.seq = r.seq WHERE r.batch = ?1");
    row.with(batch);
    std::vector<std::string> ids;
    while (row.next()) ids.push_back(row.text(0));
    return ids;
}

Unsettled settle_batches(Connection& store, UnixMs heard_before) {
    // The notification of a batch's end is written in the transaction that finds the end.
    store
        .use(
            "INSERT INTO deliveries (target, batch, created_at, due_at) SELECT notify, id, max(last_end, created_at), "
            "max(last_end, created_at) FROM batches WHERE ended_at IS NULL AND state = 'sealed' AND queued = 0 "
            "AND running = 0 AND notify IS NOT NULL")
        .run();
    store
        .use(
            "UPDATE batches SET ended_at = max(last_end, created_at) WHERE ended_at IS NULL AND state = 'sealed' "
            "AND queued = 0 AND running = 0")
        .run();
    store.use("UPDATE batches SET state = 'leaving' WHERE ended_at IS NULL AND state = 'receiving' AND heard_at < ?1")
        .with(heard_before)
        .run();
    Unsettled unsettled;
    {
        Connection::Use row = store.use("SELECT seq FROM batches WHERE ended_at IS NULL AND state = 'leaving'");
        unsettled.leaving = numbers(row);
    }
    Connection::Use row = store.use(
        "SELECT seq FROM batches WHERE ended_at IS NULL AND state <> 'leaving' AND cancel_requested AND queued > 0");
    unsettled.cancelling = numbers(row);
    return unsettled;
}

namespace {

std::size_t sweep_state(Connection& store, JobStatus status, UnixMs ended_before, std::size_t max) {
    std::vector<std::int64_t> due;
    {
        const std::string name(to_string(status));
        Connection::Use row = store.use(
            "SELECT seq FROM ended WHERE single AND status = ?1 AND finished_at < ?2 ORDER BY finished_at LIMIT ?3");
        due = numbers(row.with(name, ended_before, static_cast<std::int64_t>(max)));
    }
    for (const std::int64_t seq : due) {
        store.use("DELETE FROM ended WHERE seq = ?1").with(seq).run();
        store.use("DELETE FROM jobs WHERE seq = ?1").with(seq).run();
    }
    return due.size();
}

std::size_t sweep_batch(Connection& store, UnixMs ended_before, std::size_t max) {
    settle_batches(store, 0);
    for (;;) {
        std::int64_t batch = 0;
        {
            Connection::Use row = store.use(
                "SELECT seq FROM batches WHERE ended_at IS NULL AND state = 'leaving' UNION ALL "
                "SELECT * FROM (SELECT seq FROM batches WHERE ended_at IS NOT NULL AND ended_at < ?1 "
                "ORDER BY ended_at) LIMIT 1");
            if (!row.with(ended_before).next()) return 0;
            batch = row.integer(0);
        }
        leave(store, batch);
        if (const std::size_t gone = delete_entries(store, batch, max); gone > 0) return gone;
    }
}

}  // namespace

std::size_t sweep_slice(Connection& store, UnixMs now, const Retention& retention, std::size_t max) {
    const std::size_t slice = std::min(max, kSliceEntries);
    for (const auto& [status, age] : retention.by_state())
        if (age)
            if (const std::size_t gone = sweep_state(store, status, now - age->count(), slice); gone > 0) return gone;
    const auto longest = retention.longest();
    return longest ? sweep_batch(store, now - longest->count(), slice) : 0;
}

}  // namespace tunewright::server
