// Files of earlier versions, and what the schema refuses whoever writes.
#include <filesystem>

#include "server/store/sqlite/sqlite_store.h"
#include "tests/server/store/sqlite_file.h"
#include "tests/server/store/store_conformance.h"
#include "tests/server/store/temporary_folder.h"

namespace tunewright::server {
namespace {

// As version 0.1.0 made it, with a job of each state, a request and a result, a key, and one job deleted at the end.
constexpr const char* kFirstSchema = R"sql(
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
)sql";

TEST(SqliteSchema, AFileOfTheFirstVersionKeepsEverythingItHolds) {
    const TemporaryFolder folder;
    run_sqlite(folder.file(), std::string("PRAGMA foreign_keys = ON;") + kFirstSchema);
    const auto store = open_sqlite_store(folder.file());
    const Recovery recovery = store->recover(9000, 10, "{}");
    EXPECT_EQ(recovery.queued, 3U);
    EXPECT_EQ(recovery.interrupted, 1U);
    const JobRecord done = store->find("done").value();
    EXPECT_EQ(done.status, JobStatus::succeeded);
    EXPECT_EQ(done.request, R"({"of":"done"})");
    EXPECT_EQ(done.result, R"({"x":1})");
    EXPECT_EQ(done.finished_at, 300);
    EXPECT_EQ(store->find("broken").value().error, R"({"type":"bad"})");
    EXPECT_EQ(store->find("waiting").value().timeout_s, 12.5);
    std::string order;
    for (int i = 0; i < 3; i++)
        order += completed<std::vector<JobRecord>>([&](auto told) {
                     store->claim({"worker", 9001, std::chrono::minutes(1), 1}, told);
                 })
                     .at(0)
                     .id +
                 " ";
    EXPECT_EQ(order, "interrupted waiting later ");
    EXPECT_EQ(store->find("interrupted").value().attempts, 4);

    NewJob again;
    again.id = "again";
    again.request_hash = "h1";
    again.idempotency_key = "key";
    EXPECT_EQ(completed<Accepted>([&](auto told) { store->accept(again, told); }).job.id, "done");
    again.idempotency_key = "";
    EXPECT_EQ(completed<Accepted>([&](auto told) { store->accept(again, told); }).job.seq, 10)
        << "a number that was given once is not given again";
    EXPECT_EQ(run_sqlite(folder.file(), "PRAGMA foreign_key_check"), "");
    EXPECT_EQ(run_sqlite(folder.file(), "PRAGMA integrity_check"), "ok");
}

TEST(SqliteSchema, TheFileItselfRefusesWhatTheStatesDoNotAllow) {
    const TemporaryFolder folder;
    const auto store = open_sqlite_store(folder.file());
    for (const char* id : {"ended", "running", "waiting"}) {
        NewJob job;
        job.id = id;
        completed<Accepted>([&](auto told) { store->accept(job, told); });
    }
    completed<std::vector<JobRecord>>([&](auto told) { store->claim({"w", 1, std::chrono::minutes(1), 2}, told); });
    completed<bool>([&](auto told) { store->finish({"ended", 1, JobStatus::succeeded, "{}", "", "1", 2}, told); });
    for (const char* change : {
             "status = 'queued', finished_at = NULL WHERE id = 'ended'",
             "status = 'failed' WHERE id = 'ended'",
             "attempts = 0 WHERE id = 'running'",
             "attempts = 5 WHERE id = 'running'",
             "worker = NULL WHERE id = 'running'",
             "lease_until = NULL WHERE id = 'running'",
             "status = 'succeeded', worker = NULL, lease_until = NULL WHERE id = 'running'",
             "status = 'succeeded', finished_at = 1 WHERE id = 'waiting'",
             "status = 'running' WHERE id = 'waiting'",
             "finished_at = 1 WHERE id = 'waiting'",
         })
        EXPECT_ANY_THROW(run_sqlite(folder.file(), std::string("UPDATE jobs SET ") + change)) << change;
    EXPECT_EQ(run_sqlite(folder.file(), "SELECT group_concat(status, ' ') FROM (SELECT status FROM jobs ORDER BY seq)"),
              "succeeded running queued");
}

}  // namespace
}  // namespace tunewright::server
