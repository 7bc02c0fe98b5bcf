// The tables of the SQLite store and the steps that lead to them.
#include "server/store/sqlite/schema.h"

#include <array>
#include <string>

#include "server/store/store.h"

namespace tunewright::server {
namespace {

// The database enforces the rules of the states too: an ended job has a time and an outcome, a running one a start.
constexpr const char* kStep1 = R"sql(
CREATE TABLE jobs (
    seq INTEGER PRIMARY KEY AUTOINCREMENT,
    id TEXT NOT NULL UNIQUE CHECK (length(id) > 0),
    name TEXT NOT NULL,
    status TEXT NOT NULL CHECK (status IN ('queued', 'running', 'succeeded', 'failed', 'cancelled')),
    created_at INTEGER NOT NULL,
    started_at INTEGER,
    finished_at INTEGER,
    attempts INTEGER NOT NULL DEFAULT 0 CHECK (attempts >= 0),
    timeout_s REAL NOT NULL CHECK (timeout_s > 0),
    request_hash TEXT NOT NULL,
    cancel_requested INTEGER NOT NULL DEFAULT 0 CHECK (cancel_requested IN (0, 1)),
    version TEXT,
    CHECK ((finished_at IS NOT NULL) = (status IN ('succeeded', 'failed', 'cancelled'))),
    CHECK (status <> 'running' OR (started_at IS NOT NULL AND attempts > 0)),
    CHECK (status <> 'succeeded' OR attempts > 0)
);
CREATE INDEX jobs_queued ON jobs (seq) WHERE status = 'queued';
CREATE INDEX jobs_running ON jobs (seq) WHERE status = 'running';
CREATE INDEX jobs_by_status ON jobs (status, seq);
CREATE INDEX jobs_by_name ON jobs (name, seq);
CREATE TABLE requests (
    seq INTEGER PRIMARY KEY REFERENCES jobs (seq) ON DELETE CASCADE,
    body TEXT NOT NULL
);
CREATE TABLE results (
    seq INTEGER PRIMARY KEY REFERENCES jobs (seq) ON DELETE CASCADE,
    body TEXT,
    error TEXT,
    CHECK (body IS NOT NULL OR error IS NOT NULL)
);
CREATE TABLE idempotency_keys (
    key TEXT PRIMARY KEY,
    seq INTEGER NOT NULL REFERENCES jobs (seq) ON DELETE CASCADE
);
CREATE INDEX idempotency_keys_by_job ON idempotency_keys (seq);
)sql";

// Leases, owners, turns and batches. A table's CHECKs cannot be changed, so `jobs` is created again and its rows are
// copied. A batch has counts of its entries. One that is `leaving` is being deleted, slice by slice, and no longer
// visible; `cancel_from` is the first entry that its cancellation has not reached yet.
constexpr const char* kStep2 = R"sql(
CREATE TABLE batches (
    seq INTEGER PRIMARY KEY AUTOINCREMENT,
    id TEXT NOT NULL UNIQUE CHECK (length(id) > 0),
    name TEXT NOT NULL,
    owner TEXT NOT NULL,
    flow TEXT NOT NULL,
    created_at INTEGER NOT NULL,
    heard_at INTEGER NOT NULL,
    state TEXT NOT NULL CHECK (state IN ('receiving', 'sealed', 'leaving')),
    cancel_requested INTEGER NOT NULL DEFAULT 0 CHECK (cancel_requested IN (0, 1)),
    cancel_from INTEGER CHECK (cancel_from IS NULL OR cancel_requested),
    request_hash TEXT NOT NULL DEFAULT '',
    queued INTEGER NOT NULL DEFAULT 0 CHECK (queued >= 0),
    running INTEGER NOT NULL DEFAULT 0 CHECK (running >= 0),
    succeeded INTEGER NOT NULL DEFAULT 0 CHECK (succeeded >= 0),
    failed INTEGER NOT NULL DEFAULT 0 CHECK (failed >= 0),
    cancelled INTEGER NOT NULL DEFAULT 0 CHECK (cancelled >= 0),
    last_end INTEGER NOT NULL DEFAULT 0
);
CREATE INDEX batches_unsettled ON batches (state) WHERE state <> 'sealed' OR cancel_from IS NOT NULL;
CREATE INDEX batches_by_owner ON batches (owner);
CREATE TABLE batch_keys (
    owner TEXT NOT NULL,
    key TEXT NOT NULL,
    batch INTEGER NOT NULL REFERENCES batches (seq) ON DELETE CASCADE,
    PRIMARY KEY (owner, key)
) WITHOUT ROWID;
CREATE INDEX batch_keys_by_batch ON batch_keys (batch);

CREATE TABLE new_jobs (
    seq INTEGER PRIMARY KEY AUTOINCREMENT,
    id TEXT NOT NULL UNIQUE CHECK (length(id) > 0),
    name TEXT NOT NULL,
    status TEXT NOT NULL CHECK (status IN ('queued', 'running', 'succeeded', 'failed', 'cancelled')),
    class INTEGER NOT NULL,
    turn INTEGER NOT NULL,
    owner TEXT NOT NULL,
    flow TEXT NOT NULL,
    batch INTEGER REFERENCES batches (seq),
    batch_index INTEGER CHECK (batch_index >= 0),
    created_at INTEGER NOT NULL,
    started_at INTEGER,
    finished_at INTEGER,
    attempts INTEGER NOT NULL DEFAULT 0 CHECK (attempts >= 0),
    worker TEXT,
    lease_until INTEGER,
    timeout_s REAL NOT NULL CHECK (timeout_s > 0),
    request_hash TEXT NOT NULL,
    cancel_requested INTEGER NOT NULL DEFAULT 0 CHECK (cancel_requested IN (0, 1)),
    version TEXT,
    CHECK ((finished_at IS NOT NULL) = (status IN ('succeeded', 'failed', 'cancelled'))),
    CHECK (status <> 'running' OR (started_at IS NOT NULL AND attempts > 0)),
    CHECK ((worker IS NOT NULL) = (status = 'running') AND (lease_until IS NOT NULL) = (status = 'running')),
    CHECK (status <> 'succeeded' OR attempts > 0),
    CHECK (class = (batch IS NOT NULL) AND (batch IS NULL) = (batch_index IS NULL))
);
INSERT INTO new_jobs (seq, id, name, status, class, turn, owner, flow, created_at, started_at, finished_at, attempts,
                      worker, lease_until, timeout_s, request_hash, cancel_requested, version)
    SELECT seq, id, name, status, 0, seq, '', '', created_at, started_at, finished_at, attempts,
           iif(status = 'running', 'of an earlier version', NULL), iif(status = 'running', 0, NULL),
           timeout_s, request_hash, cancel_requested, version FROM jobs;
DELETE FROM sqlite_sequence WHERE name = 'new_jobs';
INSERT INTO sqlite_sequence (name, seq) SELECT 'new_jobs', seq FROM sqlite_sequence WHERE name = 'jobs';
DROP TABLE jobs;
ALTER TABLE new_jobs RENAME TO jobs;
CREATE INDEX jobs_waiting ON jobs (class, turn) WHERE status = 'queued';
CREATE INDEX jobs_flows ON jobs (class, flow, turn) WHERE status = 'queued';
CREATE INDEX jobs_running ON jobs (class, turn) WHERE status = 'running';
CREATE INDEX jobs_single ON jobs (seq) WHERE class = 0;
CREATE INDEX jobs_by_status ON jobs (status) WHERE class = 0;
CREATE INDEX jobs_by_name ON jobs (name) WHERE class = 0;
CREATE INDEX jobs_by_owner ON jobs (owner) WHERE class = 0;
CREATE INDEX jobs_by_end ON jobs (finished_at) WHERE class = 0 AND finished_at IS NOT NULL;
CREATE UNIQUE INDEX jobs_by_batch ON jobs (batch, batch_index) WHERE batch IS NOT NULL;

CREATE TABLE progress (
    seq INTEGER PRIMARY KEY REFERENCES jobs (seq) ON DELETE CASCADE,
    attempts INTEGER NOT NULL,
    body TEXT NOT NULL
);
CREATE TABLE new_keys (
    owner TEXT NOT NULL,
    key TEXT NOT NULL,
    seq INTEGER NOT NULL REFERENCES jobs (seq) ON DELETE CASCADE,
    PRIMARY KEY (owner, key)
) WITHOUT ROWID;
INSERT INTO new_keys (owner, key, seq) SELECT '', key, seq FROM idempotency_keys;
DROP TABLE idempotency_keys;
ALTER TABLE new_keys RENAME TO idempotency_keys;
CREATE INDEX idempotency_keys_by_job ON idempotency_keys (seq);

CREATE TRIGGER jobs_move BEFORE UPDATE OF status ON jobs
    WHEN OLD.status IN ('succeeded', 'failed', 'cancelled')
      OR (OLD.status = 'queued' AND NEW.status IN ('succeeded', 'failed'))
BEGIN
    SELECT RAISE(ABORT, 'a job cannot move from its state to that one');
END;
CREATE TRIGGER jobs_attempts BEFORE UPDATE OF status, attempts ON jobs
    WHEN NEW.attempts <> OLD.attempts + (OLD.status = 'queued' AND NEW.status = 'running')
BEGIN
    SELECT RAISE(ABORT, 'the attempts of a job count its claims');
END;
CREATE TRIGGER entries_added AFTER INSERT ON jobs WHEN NEW.batch IS NOT NULL BEGIN
    UPDATE batches SET queued = queued + (NEW.status = 'queued'), running = running + (NEW.status = 'running'),
        succeeded = succeeded + (NEW.status = 'succeeded'), failed = failed + (NEW.status = 'failed'),
        cancelled = cancelled + (NEW.status = 'cancelled'), last_end = max(last_end, coalesce(NEW.finished_at, 0))
        WHERE seq = NEW.batch;
END;
CREATE TRIGGER entries_moved AFTER UPDATE OF status ON jobs WHEN NEW.batch IS NOT NULL BEGIN
    UPDATE batches SET queued = queued + (NEW.status = 'queued') - (OLD.status = 'queued'),
        running = running + (NEW.status = 'running') - (OLD.status = 'running'),
        succeeded = succeeded + (NEW.status = 'succeeded') - (OLD.status = 'succeeded'),
        failed = failed + (NEW.status = 'failed') - (OLD.status = 'failed'),
        cancelled = cancelled + (NEW.status = 'cancelled') - (OLD.status = 'cancelled'),
        last_end = max(last_end, coalesce(NEW.finished_at, 0))
        WHERE seq = NEW.batch;
END;
)sql";

// A job that was running when its process ended may be the cause; one for which that happened twice waits a while and
// then runs alone.
constexpr const char* kStep3 = R"sql(
ALTER TABLE jobs ADD COLUMN crashes INTEGER NOT NULL DEFAULT 0 CHECK (crashes >= 0);
ALTER TABLE jobs ADD COLUMN not_before INTEGER;
CREATE INDEX jobs_suspect ON jobs (not_before) WHERE status = 'queued' AND crashes > 1;
)sql";

// The outline of an ended job for lists: small, so that a page of jobs reads no result.
constexpr const char* kStep4 = "ALTER TABLE jobs ADD COLUMN outline TEXT;";

// A job is in one of three places: it waits, it runs, or it has ended. Its constant data are in `jobs`, written once;
// `waiting` and `running` are narrow, so that a claim and an end touch no wide row and few indexes. `workers` has the
// heartbeats of processes, one row each. `ended_at` of a batch is null while jobs of it wait or run, or its end has not
// been noticed yet.
constexpr const char* kStep5 = R"sql(
DROP TRIGGER jobs_move;
DROP TRIGGER jobs_attempts;
DROP TRIGGER entries_added;
DROP TRIGGER entries_moved;

CREATE TABLE new_batches (
    seq INTEGER PRIMARY KEY AUTOINCREMENT,
    id TEXT NOT NULL UNIQUE CHECK (length(id) > 0),
    name TEXT NOT NULL,
    owner TEXT NOT NULL,
    flow TEXT NOT NULL,
    created_at INTEGER NOT NULL,
    heard_at INTEGER NOT NULL,
    state TEXT NOT NULL CHECK (state IN ('receiving', 'sealed', 'leaving')),
    cancel_requested INTEGER NOT NULL DEFAULT 0 CHECK (cancel_requested IN (0, 1)),
    request_hash TEXT NOT NULL DEFAULT '',
    idempotency_key TEXT,
    notify TEXT,
    request_id TEXT NOT NULL DEFAULT '',
    traceparent TEXT NOT NULL DEFAULT '',
    queued INTEGER NOT NULL DEFAULT 0 CHECK (queued >= 0),
    running INTEGER NOT NULL DEFAULT 0 CHECK (running >= 0),
    succeeded INTEGER NOT NULL DEFAULT 0 CHECK (succeeded >= 0),
    failed INTEGER NOT NULL DEFAULT 0 CHECK (failed >= 0),
    cancelled INTEGER NOT NULL DEFAULT 0 CHECK (cancelled >= 0),
    last_end INTEGER NOT NULL DEFAULT 0,
    ended_at INTEGER
);
INSERT INTO new_batches (seq, id, name, owner, flow, created_at, heard_at, state, cancel_requested, request_hash,
                         idempotency_key, queued, running, succeeded, failed, cancelled, last_end)
    SELECT b.seq, b.id, b.name, b.owner, b.flow, b.created_at, b.heard_at, b.state, b.cancel_requested,
           b.request_hash, k.key, b.queued, b.running, b.succeeded, b.failed, b.cancelled, b.last_end
    FROM batches b LEFT JOIN batch_keys k ON k.batch = b.seq;
DELETE FROM sqlite_sequence WHERE name = 'new_batches';
INSERT INTO sqlite_sequence (name, seq) SELECT 'new_batches', seq FROM sqlite_sequence WHERE name = 'batches';

CREATE TABLE new_jobs (
    seq INTEGER PRIMARY KEY AUTOINCREMENT,
    id TEXT NOT NULL UNIQUE CHECK (length(id) > 0),
    name TEXT NOT NULL,
    owner TEXT NOT NULL,
    flow TEXT NOT NULL,
    class INTEGER NOT NULL CHECK (class IN (0, 1)),
    turn INTEGER NOT NULL,
    batch INTEGER,
    batch_index INTEGER CHECK (batch_index >= 0),
    created_at INTEGER NOT NULL,
    timeout_s REAL NOT NULL CHECK (timeout_s > 0),
    request_hash TEXT NOT NULL,
    idempotency_key TEXT,
    notify TEXT,
    request_id TEXT NOT NULL DEFAULT '',
    traceparent TEXT NOT NULL DEFAULT '',
    request TEXT,
    CHECK ((batch IS NULL) = (batch_index IS NULL))
);
INSERT INTO new_jobs (seq, id, name, owner, flow, class, turn, batch, batch_index, created_at, timeout_s, request_hash,
                      idempotency_key, request)
    SELECT j.seq, j.id, j.name, j.owner, j.flow, j.class, j.turn, j.batch, j.batch_index, j.created_at, j.timeout_s,
           j.request_hash, k.key, q.body
    FROM jobs j LEFT JOIN idempotency_keys k ON k.seq = j.seq LEFT JOIN requests q ON q.seq = j.seq;
DELETE FROM sqlite_sequence WHERE name = 'new_jobs';
INSERT INTO sqlite_sequence (name, seq) SELECT 'new_jobs', seq FROM sqlite_sequence WHERE name = 'jobs';

CREATE TABLE waiting (
    class INTEGER NOT NULL,
    turn INTEGER NOT NULL,
    seq INTEGER NOT NULL,
    flow TEXT NOT NULL,
    batch INTEGER,
    attempts INTEGER NOT NULL DEFAULT 0 CHECK (attempts >= 0),
    crashes INTEGER NOT NULL DEFAULT 0 CHECK (crashes >= 0 AND crashes <= attempts),
    not_before INTEGER,
    PRIMARY KEY (class, turn, seq)
) WITHOUT ROWID;
INSERT INTO waiting SELECT class, turn, seq, flow, batch, attempts, min(crashes, attempts), not_before FROM jobs
    WHERE status = 'queued';
CREATE INDEX waiting_flows ON waiting (class, flow, turn);
CREATE INDEX waiting_single ON waiting (seq) WHERE batch IS NULL;
CREATE INDEX waiting_suspects ON waiting (not_before) WHERE crashes > 1;

CREATE TABLE running (
    seq INTEGER PRIMARY KEY,
    class INTEGER NOT NULL,
    turn INTEGER NOT NULL,
    flow TEXT NOT NULL,
    batch INTEGER,
    worker TEXT NOT NULL,
    attempts INTEGER NOT NULL CHECK (attempts > 0),
    crashes INTEGER NOT NULL CHECK (crashes >= 0 AND crashes < attempts),
    started_at INTEGER NOT NULL,
    cancel_requested INTEGER NOT NULL DEFAULT 0 CHECK (cancel_requested IN (0, 1)),
    progress TEXT
);
INSERT INTO running SELECT seq, class, turn, flow, batch, worker, attempts, min(crashes, attempts - 1), started_at,
    cancel_requested, NULL FROM jobs WHERE status = 'running';

CREATE TABLE ended (
    seq INTEGER PRIMARY KEY,
    single INTEGER NOT NULL CHECK (single IN (0, 1)),
    status TEXT NOT NULL CHECK (status IN ('succeeded', 'failed', 'cancelled')),
    attempts INTEGER NOT NULL CHECK (attempts >= 0),
    cancel_requested INTEGER NOT NULL,
    started_at INTEGER,
    finished_at INTEGER NOT NULL,
    version TEXT,
    outline TEXT,
    error TEXT,
    result TEXT,
    CHECK (status <> 'succeeded' OR (attempts > 0 AND started_at IS NOT NULL))
);
INSERT INTO ended SELECT j.seq, j.batch IS NULL, j.status, j.attempts, j.cancel_requested, j.started_at, j.finished_at,
        j.version, j.outline, r.error, r.body
    FROM jobs j LEFT JOIN results r ON r.seq = j.seq WHERE j.finished_at IS NOT NULL;

CREATE TABLE workers (name TEXT PRIMARY KEY, lease_until INTEGER NOT NULL) WITHOUT ROWID;
CREATE TABLE settings (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE deliveries (
    seq INTEGER PRIMARY KEY AUTOINCREMENT,
    target TEXT NOT NULL,
    job TEXT NOT NULL DEFAULT '',
    batch TEXT NOT NULL DEFAULT '',
    tries INTEGER NOT NULL DEFAULT 0,
    created_at INTEGER NOT NULL,
    due_at INTEGER NOT NULL,
    CHECK ((job = '') <> (batch = ''))
);
CREATE INDEX deliveries_due ON deliveries (due_at);

DROP TABLE batch_keys;
DROP TABLE idempotency_keys;
DROP TABLE progress;
DROP TABLE results;
DROP TABLE requests;
DROP TABLE jobs;
DROP TABLE batches;
ALTER TABLE new_batches RENAME TO batches;
ALTER TABLE new_jobs RENAME TO jobs;
CREATE INDEX batches_unsettled ON batches (state) WHERE ended_at IS NULL;
CREATE INDEX batches_by_end ON batches (ended_at) WHERE ended_at IS NOT NULL;
CREATE INDEX batches_by_owner ON batches (owner) WHERE owner <> '';
CREATE UNIQUE INDEX batches_by_key ON batches (owner, idempotency_key) WHERE idempotency_key IS NOT NULL;
CREATE INDEX jobs_single ON jobs (seq) WHERE batch IS NULL;
CREATE INDEX jobs_by_name ON jobs (name) WHERE batch IS NULL AND name <> '';
CREATE INDEX jobs_by_owner ON jobs (owner) WHERE batch IS NULL AND owner <> '';
CREATE UNIQUE INDEX jobs_by_key ON jobs (owner, idempotency_key) WHERE idempotency_key IS NOT NULL;
CREATE UNIQUE INDEX jobs_by_batch ON jobs (batch, batch_index) WHERE batch IS NOT NULL;
CREATE INDEX jobs_notify ON jobs (seq) WHERE notify IS NOT NULL;
CREATE INDEX ended_by_status ON ended (status) WHERE single;
CREATE INDEX ended_by_end ON ended (status, finished_at) WHERE single;

CREATE TRIGGER waits_in_one_place BEFORE INSERT ON waiting
    WHEN EXISTS (SELECT 1 FROM running WHERE seq = NEW.seq) OR EXISTS (SELECT 1 FROM ended WHERE seq = NEW.seq)
BEGIN SELECT RAISE(ABORT, 'a job cannot be in two places'); END;
CREATE TRIGGER runs_in_one_place BEFORE INSERT ON running WHEN EXISTS (SELECT 1 FROM ended WHERE seq = NEW.seq)
BEGIN SELECT RAISE(ABORT, 'a job cannot be in two places'); END;
CREATE TRIGGER ends_in_one_place BEFORE INSERT ON ended WHEN EXISTS (SELECT 1 FROM running WHERE seq = NEW.seq)
BEGIN SELECT RAISE(ABORT, 'a job cannot be in two places'); END;
CREATE TRIGGER ends_for_good BEFORE UPDATE ON ended BEGIN SELECT RAISE(ABORT, 'an ended job does not change'); END;
CREATE TRIGGER runs_as_claimed BEFORE UPDATE OF seq, worker, attempts, crashes ON running
BEGIN SELECT RAISE(ABORT, 'a job that runs is its worker''s'); END;
)sql";

// Entries of a batch that ended in a state that few entries have.
constexpr const char* kStep6 = "CREATE INDEX ended_entries ON ended (status) WHERE NOT single;";

// The time before which a job does not start, and an index for counting the single jobs of one client; single jobs of
// low priority share a class with entries of batches. With an index WHERE class = 1 SQLite would compile every
// statement with class = ?1 again each time.
constexpr const char* kStep7 = R"sql(
ALTER TABLE jobs ADD COLUMN not_before INTEGER;
CREATE INDEX waiting_clients ON waiting (flow, batch, class) WHERE class > 0 AND batch IS NULL;
)sql";

constexpr std::array kSteps{kStep1, kStep2, kStep3, kStep4, kStep5, kStep6, kStep7};

/// In one transaction: if one of them fails, the file is as it was, for a program of its schema too.
void take_steps(SQLite::Database& database, const SchemaState& state) {
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    for (int step = state.have; step < state.known; step++) database.exec(kSteps[static_cast<std::size_t>(step)]);
    database.exec("PRAGMA user_version = " + std::to_string(state.known));
    transaction.commit();
}

}  // namespace

SchemaState schema_state(SQLite::Database& database) {
    const SchemaState state{database.execAndGet("PRAGMA user_version").getInt(), static_cast<int>(kSteps.size())};
    if (state.have > state.known)
        throw StoreError({StoreFault::Kind::unavailable, "it has schema " + std::to_string(state.have) +
                                                             " of a newer program; this one knows " +
                                                             std::to_string(state.known)});
    return state;
}

void migrate(SQLite::Database& database) {
    const SchemaState state = schema_state(database);
    // A table that is created again is dropped once; the requests and results of its rows must not be deleted with it.
    database.exec("PRAGMA foreign_keys = OFF");
    if (state.have < state.known) take_steps(database, state);
    database.exec("PRAGMA foreign_keys = ON");
}

}  // namespace tunewright::server
