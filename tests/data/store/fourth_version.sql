-- The schema, to be run with foreign keys on.
CREATE TABLE requests (seq INTEGER PRIMARY KEY REFERENCES jobs (seq) ON DELETE CASCADE, body TEXT NOT NULL);
CREATE TABLE results (
    seq INTEGER PRIMARY KEY REFERENCES jobs (seq) ON DELETE CASCADE,
    body TEXT,
    error TEXT,
    CHECK (body IS NOT NULL OR error IS NOT NULL)
);
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
CREATE TABLE jobs (
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
    crashes INTEGER NOT NULL DEFAULT 0 CHECK (crashes >= 0),
    not_before INTEGER,
    outline TEXT,
    CHECK ((finished_at IS NOT NULL) = (status IN ('succeeded', 'failed', 'cancelled'))),
    CHECK (status <> 'running' OR (started_at IS NOT NULL AND attempts > 0)),
    CHECK ((worker IS NOT NULL) = (status = 'running') AND (lease_until IS NOT NULL) = (status = 'running')),
    CHECK (status <> 'succeeded' OR attempts > 0),
    CHECK (class = (batch IS NOT NULL) AND (batch IS NULL) = (batch_index IS NULL))
);
CREATE INDEX jobs_waiting ON jobs (class, turn) WHERE status = 'queued';
CREATE INDEX jobs_flows ON jobs (class, flow, turn) WHERE status = 'queued';
CREATE INDEX jobs_running ON jobs (class, turn) WHERE status = 'running';
CREATE INDEX jobs_single ON jobs (seq) WHERE class = 0;
CREATE INDEX jobs_by_status ON jobs (status) WHERE class = 0;
CREATE INDEX jobs_by_name ON jobs (name) WHERE class = 0;
CREATE INDEX jobs_by_owner ON jobs (owner) WHERE class = 0;
CREATE INDEX jobs_by_end ON jobs (finished_at) WHERE class = 0 AND finished_at IS NOT NULL;
CREATE UNIQUE INDEX jobs_by_batch ON jobs (batch, batch_index) WHERE batch IS NOT NULL;
CREATE INDEX jobs_suspect ON jobs (not_before) WHERE status = 'queued' AND crashes > 1;
CREATE TABLE progress (
    seq INTEGER PRIMARY KEY REFERENCES jobs (seq) ON DELETE CASCADE,
    attempts INTEGER NOT NULL,
    body TEXT NOT NULL
);
CREATE TABLE idempotency_keys (
    owner TEXT NOT NULL,
    key TEXT NOT NULL,
    seq INTEGER NOT NULL REFERENCES jobs (seq) ON DELETE CASCADE,
    PRIMARY KEY (owner, key)
) WITHOUT ROWID;
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
PRAGMA user_version = 4;

-- Jobs on every way: waiting, running, ended in each manner, single and in a batch.
INSERT INTO batches (seq, id, name, owner, flow, created_at, heard_at, state, cancel_requested, cancel_from,
                     request_hash)
VALUES
    (1, 'nightly', 'all loops', 'me', 'me', 1000, 1100, 'sealed', 0, NULL, 'batch hash'),
    (2, 'receiving', '', '', 'x', 1001, 1101, 'receiving', 0, NULL, ''),
    (3, 'leaving', '', '', 'x', 1002, 1102, 'leaving', 0, NULL, ''),
    (4, 'cancelling', '', 'you', 'you', 1003, 1103, 'sealed', 1, 1, 'other hash'),
    (5, 'over', '', 'me', 'me', 1004, 1104, 'sealed', 0, NULL, 'third hash');
INSERT INTO batch_keys VALUES ('me', 'night', 1);

INSERT INTO jobs (seq, id, name, status, class, turn, owner, flow, batch, batch_index, created_at, started_at,
                  finished_at, attempts, timeout_s, request_hash, cancel_requested, version, crashes, outline)
VALUES
    (1, 'succeeded', 'one', 'succeeded', 0, 1, 'me', 'me', NULL, NULL, 100, 200, 300, 1, 60, 'h1', 0, '0.2.0', 0,
     '{"method":"simc"}'),
    (2, 'failed', 'two', 'failed', 0, 1, '', 'x', NULL, NULL, 101, 201, 301, 2, 60, 'h2', 0, '0.2.0', 1, NULL),
    (3, 'timed-out', 'three', 'failed', 0, 2, '', 'x', NULL, NULL, 102, 202, 302, 1, 0.5, 'h3', 0, '0.2.0', 0, NULL),
    (4, 'cancelled', 'four', 'cancelled', 0, 3, '', 'x', NULL, NULL, 103, 203, 303, 1, 60, 'h4', 1, '0.2.0', 0, NULL),
    (5, 'unwanted', 'five', 'cancelled', 0, 4, '', 'x', NULL, NULL, 104, NULL, 304, 0, 60, 'h5', 1, NULL, 0, NULL),
    (12, 'nightly-0', 'loop 0', 'succeeded', 1, 1, 'me', 'me', 1, 0, 112, 212, 312, 1, 60, 'e0', 0, '0.2.0', 0, NULL),
    (13, 'nightly-1', 'loop 1', 'failed', 1, 2, 'me', 'me', 1, 1, 112, 213, 313, 1, 60, 'e1', 0, '0.2.0', 0, NULL),
    (14, 'nightly-2', 'loop 2', 'cancelled', 1, 3, 'me', 'me', 1, 2, 112, NULL, 314, 0, 60, 'e2', 1, NULL, 0, NULL),
    (17, 'nightly-5', '', 'failed', 1, 6, 'me', 'me', 1, 5, 112, NULL, 112, 0, 60, '', 0, NULL, 0, '{"plant":"?"}'),
    (19, 'leaving-0', '', 'succeeded', 1, 1, '', 'x', 3, 0, 119, 219, 319, 1, 60, 'l0', 0, '0.2.0', 0, NULL),
    (20, 'cancelling-0', '', 'cancelled', 1, 1, 'you', 'you', 4, 0, 120, NULL, 320, 0, 60, 'c0', 1, NULL, 0, NULL),
    (22, 'over-0', '', 'succeeded', 1, 7, 'me', 'me', 5, 0, 1004, 1222, 1322, 1, 60, 'o0', 0, '0.2.0', 0, NULL);
INSERT INTO jobs (seq, id, name, status, class, turn, owner, flow, batch, batch_index, created_at, started_at, attempts,
                  worker, lease_until, timeout_s, request_hash, cancel_requested, crashes)
VALUES
    (6, 'running', 'six', 'running', 0, 5, '', 'x', NULL, NULL, 105, 205, 2, 'gone', 5000, 60, 'h6', 0, 1),
    (7, 'stopping', 'seven', 'running', 0, 6, '', 'x', NULL, NULL, 106, 206, 1, 'gone', 5000, 60, 'h7', 1, 0),
    (15, 'nightly-3', 'loop 3', 'running', 1, 4, 'me', 'me', 1, 3, 112, 215, 1, 'gone', 5000, 60, 'e3', 0, 0);
INSERT INTO jobs (seq, id, name, status, class, turn, owner, flow, batch, batch_index, created_at, started_at, attempts,
                  timeout_s, request_hash, crashes, not_before)
VALUES
    (8, 'waiting', 'eight', 'queued', 0, 8, '', 'x', NULL, NULL, 107, NULL, 0, 12.5, 'h8', 0, NULL),
    (9, 'released', 'nine', 'queued', 0, 7, '', 'x', NULL, NULL, 108, 209, 3, 60, 'h9', 1, NULL),
    (10, 'suspect', 'ten', 'queued', 0, 6, '', 'x', NULL, NULL, 109, 210, 2, 60, 'h10', 2, 5000),
    (11, 'yours', 'eleven', 'queued', 0, 9, 'you', 'you', NULL, NULL, 110, NULL, 0, 60, 'h11', 0, NULL),
    (16, 'nightly-4', 'loop 4', 'queued', 1, 5, 'me', 'me', 1, 4, 112, NULL, 0, 60, 'e4', 0, NULL),
    (18, 'receiving-0', '', 'queued', 1, 1, '', 'x', 2, 0, 118, NULL, 0, 60, 'r0', 0, NULL),
    (21, 'cancelling-1', '', 'queued', 1, 2, 'you', 'you', 4, 1, 120, NULL, 0, 60, 'c1', 0, NULL),
    (30, 'deleted', '', 'queued', 0, 10, '', 'x', NULL, NULL, 130, NULL, 0, 60, 'h30', 0, NULL);
INSERT INTO requests SELECT seq, '{"of":"' || id || '"}' FROM jobs WHERE id <> 'nightly-5';
INSERT INTO results VALUES
    (1, '{"x":1}', NULL), (2, NULL, '{"type":"bad"}'), (3, '{"x":3}', '{"type":"timeout"}'), (4, '{"x":4}', NULL),
    (12, '{"x":12}', NULL), (13, NULL, '{"type":"bad"}'), (17, NULL, '{"type":"unreadable"}'), (19, '{"x":19}', NULL),
    (22, '{"x":22}', NULL);
INSERT INTO progress VALUES (6, 2, '{"stage":"tune"}');
INSERT INTO idempotency_keys VALUES ('me', 'mine', 1), ('you', 'mine', 11);
DELETE FROM jobs WHERE id = 'deleted';
