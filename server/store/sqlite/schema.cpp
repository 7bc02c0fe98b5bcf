#include "server/store/sqlite/schema.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include <array>
#include <string>

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

constexpr std::array kSteps{kStep1};

}  // namespace

void migrate(SQLite::Database& database) {
    const int have = database.execAndGet("PRAGMA user_version").getInt();
    if (have > static_cast<int>(kSteps.size()))
        throw StoreError({StoreFault::Kind::unavailable, "it has schema " + std::to_string(have) +
                                                             " of a newer program; this one knows " +
                                                             std::to_string(kSteps.size())});
    for (int step = have; step < static_cast<int>(kSteps.size()); step++) {
        SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
        database.exec(kSteps[static_cast<std::size_t>(step)]);
        database.exec("PRAGMA user_version = " + std::to_string(step + 1));
        transaction.commit();
    }
}

}  // namespace tunewright::server
