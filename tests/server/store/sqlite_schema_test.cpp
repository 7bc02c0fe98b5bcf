// Files of earlier versions, and what the schema refuses whoever writes.
#include <filesystem>
#include <fstream>
#include <iterator>

#include "server/store/sqlite/sqlite_store.h"
#include "tests/server/store/store_conformance.h"
#include "tests/server/store/store_file.h"
#include "tests/test_data.h"

namespace tunewright::server {
namespace {

std::string text_of(const std::string& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(SqliteSchema, AFileOfTheFirstVersionKeepsEverythingItHolds) {
    const TemporaryFolder folder;
    run_sqlite(folder.file(), "PRAGMA foreign_keys = ON;" + text_of(test_data("store/first_version.sql")));
    const auto store = open_sqlite_store(folder.file());
    const Recovery recovery = store->recover(9000, 10, "{}");
    EXPECT_EQ(store->depth().single + store->depth().entries, 3U);
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
        order += completed<std::vector<JobRecord>>([&](auto callback) {
                     store->claim({"worker", 9001, std::chrono::minutes(1), 1}, callback);
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
    EXPECT_EQ(completed<Accepted>([&](auto callback) { store->accept(again, callback); }).job.id, "done");
    again.idempotency_key = "";
    EXPECT_EQ(completed<Accepted>([&](auto callback) { store->accept(again, callback); }).job.seq, 10)
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
        completed<Accepted>([&](auto callback) { store->accept(job, callback); });
    }
    completed<std::vector<JobRecord>>([&](auto callback) {
        store->claim({"w", 1, std::chrono::minutes(1), 2}, callback);
    });
    completed<bool>([&](auto callback) {
        store->finish({"ended", 1, JobStatus::succeeded, "{}", "", "1", 2}, callback);
    });
    for (const char* change : kForbiddenChanges)
        EXPECT_ANY_THROW(run_sqlite(folder.file(), std::string("UPDATE jobs SET ") + change)) << change;
    EXPECT_EQ(run_sqlite(folder.file(), "SELECT group_concat(status, ' ') FROM (SELECT status FROM jobs ORDER BY seq)"),
              "succeeded running queued");
}

}  // namespace
}  // namespace tunewright::server
