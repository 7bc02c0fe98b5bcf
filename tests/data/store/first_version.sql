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
INSERT INTO jobs VALUES
    (1, 'done', 'one', 'succeeded', 100, 200, 300, 1, 60, 'h1', 0, '0.1.0'),
    (2, 'broken', 'two', 'failed', 101, 201, 301, 2, 60, 'h2', 0, '0.1.0'),
    (3, 'interrupted', 'three', 'running', 102, 202, NULL, 3, 60, 'h3', 0, NULL),
    (4, 'waiting', 'four', 'queued', 103, NULL, NULL, 0, 12.5, 'h4', 0, NULL),
    (5, 'later', 'five', 'queued', 104, NULL, NULL, 0, 60, 'h5', 0, NULL),
    (9, 'deleted', 'nine', 'queued', 105, NULL, NULL, 0, 60, 'h9', 0, NULL);
INSERT INTO requests SELECT seq, '{"of":"' || id || '"}' FROM jobs;
INSERT INTO results VALUES (1, '{"x":1}', NULL), (2, NULL, '{"type":"bad"}');
INSERT INTO idempotency_keys VALUES ('key', 1);
DELETE FROM jobs WHERE id = 'deleted';
PRAGMA user_version = 1;
