// The tables of the SQLite store and the steps that lead to them.
#include <array>
#include <string>

#include "server/store/sqlite/connection.h"
#include "server/store/store.h"

namespace tunewright::server {
namespace {

// The database knows the rules of the states too: an ended job has its moment and its outcome, a running one a start.
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

// Leases, owners, turns and batches. A table's CHECKs cannot be changed, so `jobs` is made anew and its rows move over.
// A batch counts its entries by itself. One that is `leaving` is being deleted, slice by slice, and no longer seen;
// `cancel_from` is the first entry that its cancelling has not reached yet.
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

// A job that was running when its process ended may be why; one that was twice waits a while and then runs alone.
constexpr const char* kStep3 = R"sql(
ALTER TABLE jobs ADD COLUMN crashes INTEGER NOT NULL DEFAULT 0 CHECK (crashes >= 0);
ALTER TABLE jobs ADD COLUMN not_before INTEGER;
CREATE INDEX jobs_suspect ON jobs (not_before) WHERE status = 'queued' AND crashes > 1;
)sql";

// What a list shows of an ended job beside its name: small, so that a page of jobs reads no result.
constexpr const char* kStep4 = "ALTER TABLE jobs ADD COLUMN outline TEXT;";

constexpr std::array kSteps{kStep1, kStep2, kStep3, kStep4};

}  // namespace

void migrate(SQLite::Database& database) {
    const int have = database.execAndGet("PRAGMA user_version").getInt();
    if (have > static_cast<int>(kSteps.size()))
        throw StoreError({StoreFault::Kind::unavailable, "it has schema " + std::to_string(have) +
                                                             " of a newer program; this one knows " +
                                                             std::to_string(kSteps.size())});
    // A table that is made anew is dropped once; its rows' requests and results must not go with it.
    database.exec("PRAGMA foreign_keys = OFF");
    for (int step = have; step < static_cast<int>(kSteps.size()); step++) {
        SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
        database.exec(kSteps[static_cast<std::size_t>(step)]);
        database.exec("PRAGMA user_version = " + std::to_string(step + 1));
        transaction.commit();
    }
    database.exec("PRAGMA foreign_keys = ON");
}

}  // namespace tunewright::server
