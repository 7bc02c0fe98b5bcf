// Files of earlier versions, and changes that the schema refuses from any writer.
#include <filesystem>
#include <fstream>
#include <iterator>

#include "server/store/open_store.h"
#include "server/store/sqlite/sqlite_store.h"
#include "tests/server/store/forbidden_changes.h"
#include "tests/server/store/store_conformance.h"
#include "tests/server/store/store_file.h"
#include "tests/test_data.h"

namespace tunewright::server {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

std::string text_of(const std::string& file) {
    std::ifstream stream(file);
    return {std::istreambuf_iterator<char>(stream), {}};
}

TEST(SqliteSchema, AFileOfTheFirstVersionKeepsEverythingItHolds) {
    const TemporaryFolder folder;
    run_sqlite(folder.file(), "PRAGMA foreign_keys = ON;" + text_of(test_data("store/first_version.sql")));
    const auto store = open_sqlite_store(folder.file(), SchemaSteps::take);
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

TEST(SqliteSchema, AFailedUpgradeLeavesTheFileAsItWas) {
    const TemporaryFolder folder;
    // A table that a later step wants to create.
    run_sqlite(folder.file(), "PRAGMA foreign_keys = ON;" + text_of(test_data("store/first_version.sql")) +
                                  "CREATE TABLE workers (of_somebody_else TEXT);");
    const auto tables = "SELECT group_concat(name || sql) FROM (SELECT * FROM sqlite_schema ORDER BY name)";
    const std::string before = run_sqlite(folder.file(), tables);
    EXPECT_ANY_THROW(open_sqlite_store(folder.file(), SchemaSteps::take));
    EXPECT_EQ(run_sqlite(folder.file(), "PRAGMA user_version"), "1");
    EXPECT_EQ(run_sqlite(folder.file(), tables), before);
    EXPECT_EQ(run_sqlite(folder.file(), "SELECT count(*) FROM jobs JOIN requests USING (seq)"), "5");

    run_sqlite(folder.file(), "DROP TABLE workers");
    EXPECT_EQ(open_sqlite_store(folder.file(), SchemaSteps::take)->find("done").value().result, R"({"x":1})");
}

/// A file of the fourth schema with jobs in every state, opened.
class SqliteFourthSchema : public testing::Test {
protected:
    SqliteFourthSchema() {
        run_sqlite(folder_.file(), "PRAGMA foreign_keys = ON;" + text_of(test_data("store/fourth_version.sql")));
        store_ = open_sqlite_store(folder_.file(), SchemaSteps::take);
    }
    JobRecord find(const std::string& id) { return store_->find(id).value(); }
    BatchSummary batch(const std::string& id) { return store_->find_batch(id).value(); }
    /// Ids of the jobs that the query finds, in their order.
    std::vector<std::string> list(const JobQuery& query) {
        std::vector<std::string> ids;
        for (const JobSummary& summary : store_->list(query).jobs) ids.push_back(summary.id);
        return ids;
    }
    std::vector<std::string> list(JobStatus status) {
        JobQuery query;
        query.status = status;
        return list(query);
    }
    std::vector<std::string> claim(UnixMs now, bool suspects) {
        const auto claimed = completed<std::vector<JobRecord>>([&](auto done) {
            store_->claim({"worker", now, std::chrono::minutes(1), 10, suspects}, done);
        });
        std::vector<std::string> ids;
        for (const JobRecord& job : claimed) ids.push_back(job.id);
        return ids;
    }

    TemporaryFolder folder_;
    std::unique_ptr<JobStore> store_;
};

TEST_F(SqliteFourthSchema, JobsThatHaveEndedReadAsBefore) {
    const JobRecord succeeded = find("succeeded");
    EXPECT_EQ(succeeded.seq, 1);
    EXPECT_EQ(succeeded.name, "one");
    EXPECT_EQ(succeeded.status, JobStatus::succeeded);
    EXPECT_EQ(succeeded.owner, "me");
    EXPECT_EQ(succeeded.created_at, 100);
    EXPECT_EQ(succeeded.started_at, 200);
    EXPECT_EQ(succeeded.finished_at, 300);
    EXPECT_EQ(succeeded.attempts, 1);
    EXPECT_EQ(succeeded.request_hash, "h1");
    EXPECT_EQ(succeeded.request, R"({"of":"succeeded"})");
    EXPECT_EQ(succeeded.result, R"({"x":1})");
    EXPECT_EQ(succeeded.error, "");
    EXPECT_EQ(succeeded.outline, R"({"method":"simc"})");
    EXPECT_EQ(succeeded.request_id + succeeded.traceparent, "") << "that version did not keep them";
    EXPECT_EQ(run_sqlite(folder_.file(), "SELECT version FROM ended WHERE seq = 1"), "0.2.0");
    EXPECT_EQ(find("failed").error, R"({"type":"bad"})");
    EXPECT_EQ(find("failed").attempts, 2);
    EXPECT_EQ(find("timed-out").error, R"({"type":"timeout"})");
    EXPECT_EQ(find("timed-out").result, R"({"x":3})");
    EXPECT_EQ(find("timed-out").timeout_s, 0.5);
    EXPECT_EQ(find("cancelled").result, R"({"x":4})");
    EXPECT_TRUE(find("cancelled").cancel_requested);
    EXPECT_EQ(find("unwanted").status, JobStatus::cancelled);
    EXPECT_EQ(find("unwanted").finished_at, 304);
    EXPECT_FALSE(find("unwanted").started_at);
    EXPECT_FALSE(store_->find("deleted"));
}

TEST_F(SqliteFourthSchema, JobsThatWaitOrRunAreWhereTheyWere) {
    EXPECT_EQ(find("waiting").status, JobStatus::queued);
    EXPECT_EQ(find("waiting").timeout_s, 12.5);
    EXPECT_EQ(find("waiting").request, R"({"of":"waiting"})");
    EXPECT_EQ(find("released").status, JobStatus::queued);
    EXPECT_EQ(find("released").attempts, 3);
    EXPECT_FALSE(find("released").started_at) << "of an earlier attempt";
    EXPECT_EQ(find("running").status, JobStatus::running);
    EXPECT_EQ(find("running").attempts, 2);
    EXPECT_EQ(find("running").started_at, 205);
    EXPECT_FALSE(find("running").cancel_requested);
    EXPECT_TRUE(find("stopping").cancel_requested);
    EXPECT_EQ(store_->depth().single, 4U);
    EXPECT_EQ(store_->depth().entries, 3U);
    EXPECT_EQ(store_->depth().suspects, 1U);
    EXPECT_FALSE(store_->depth().paused);
    EXPECT_EQ(store_->states({"running", "waiting", "nightly-3", "leaving-0"}).size(), 3U);
}

TEST_F(SqliteFourthSchema, ListsShowTheSameJobsInTheSameOrder) {
    EXPECT_THAT(list(JobQuery{}), ElementsAre("yours", "suspect", "released", "waiting", "stopping", "running",
                                              "unwanted", "cancelled", "timed-out", "failed", "succeeded"));
    EXPECT_THAT(list(JobStatus::queued), ElementsAre("yours", "suspect", "released", "waiting"));
    EXPECT_THAT(list(JobStatus::running), ElementsAre("stopping", "running"));
    EXPECT_THAT(list(JobStatus::succeeded), ElementsAre("succeeded"));
    EXPECT_THAT(list(JobStatus::failed), ElementsAre("timed-out", "failed"));
    EXPECT_THAT(list(JobStatus::cancelled), ElementsAre("unwanted", "cancelled"));
    JobQuery query;
    query.owner = "me";
    EXPECT_THAT(list(query), ElementsAre("succeeded"));
    query = {};
    query.name = "seven";
    EXPECT_THAT(list(query), ElementsAre("stopping"));
    query = {};
    query.text = "simc";
    EXPECT_THAT(list(query), ElementsAre("succeeded"));
    query = {};
    query.batch = "nightly";
    query.limit = 3;
    EXPECT_THAT(list(query), ElementsAre("nightly-5", "nightly-4", "nightly-3"));
}

TEST_F(SqliteFourthSchema, BatchesKeepTheirCountsTheirRowsAndTheirKeys) {
    const BatchSummary nightly = batch("nightly");
    EXPECT_EQ(nightly.name, "all loops");
    EXPECT_EQ(nightly.created_at, 1000);
    EXPECT_TRUE(nightly.sealed);
    EXPECT_EQ(nightly.total, 6U);
    EXPECT_EQ(nightly.queued, 1U);
    EXPECT_EQ(nightly.running, 1U);
    EXPECT_EQ(nightly.succeeded, 1U);
    EXPECT_EQ(nightly.failed, 2U);
    EXPECT_EQ(nightly.cancelled, 1U);
    EXPECT_FALSE(nightly.finished_at);
    EXPECT_EQ(batch("over").finished_at, 1322);
    EXPECT_TRUE(batch("cancelling").cancel_requested);
    EXPECT_FALSE(batch("receiving").sealed);
    EXPECT_FALSE(store_->find_batch("leaving"));
    EXPECT_FALSE(store_->find("leaving-0"));
    EXPECT_EQ(store_->list_batches(std::nullopt, 10, std::nullopt).batches.size(), 4U);
    EXPECT_EQ(store_->batch_of_key("me", "night"), "nightly");
    const auto rows = store_->batch_rows("nightly", 0, 10);
    ASSERT_EQ(rows.size(), 6U);
    EXPECT_EQ(rows[0].result, R"({"x":12})");
    EXPECT_EQ(rows[1].error, R"({"type":"bad"})");
    EXPECT_EQ(rows[2].status, JobStatus::cancelled);
    EXPECT_EQ(rows[3].status, JobStatus::running);
    EXPECT_EQ(rows[4].status, JobStatus::queued);
    EXPECT_EQ(rows[5].error, R"({"type":"unreadable"})");
    EXPECT_EQ(find("nightly-5").request, "");
    EXPECT_EQ(find("nightly-5").outline, R"({"plant":"?"})");
    EXPECT_EQ(find("nightly-4").batch, "nightly");
    EXPECT_EQ(find("nightly-4").index, 4);
}

TEST_F(SqliteFourthSchema, WorkGoesOnWhereItWas) {
    const Recovery recovery = store_->recover(9000, 10, "{}");
    EXPECT_EQ(recovery.interrupted, 2U);
    EXPECT_THAT(recovery.ended, ElementsAre("stopping"));
    EXPECT_FALSE(store_->find_batch("receiving")) << "its receiver has gone";
    EXPECT_EQ(find("cancelling-1").status, JobStatus::cancelled) << "as far as it had not come";
    EXPECT_TRUE(batch("cancelling").ended());
    EXPECT_EQ(run_sqlite(folder_.file(), "SELECT count(*) FROM jobs WHERE id LIKE 'leaving%'"), "0");
    EXPECT_THAT(claim(9001, false), ElementsAre("released", "waiting", "yours", "nightly-3", "nightly-4"));
    EXPECT_THAT(claim(9001, true), ElementsAre("suspect"));
    EXPECT_THAT(claim(10'000, true), ElementsAre("running")) << "its second crash; now it has waited for a second";
    EXPECT_EQ(find("released").attempts, 4);
    EXPECT_EQ(find("running").attempts, 3);
    const JobEnd end{16, "nightly-4", 1, JobStatus::succeeded, "{}", "", "1", 9500};
    EXPECT_TRUE(completed<bool>([&](auto done) { store_->finish(end, done); }));
    EXPECT_EQ(batch("nightly").succeeded, 2U);

    NewJob again;
    again.id = "again";
    again.owner = "you";
    again.request_hash = "h11";
    again.idempotency_key = "mine";
    EXPECT_EQ(completed<Accepted>([&](auto done) { store_->accept(again, done); }).job.id, "yours");
    again.idempotency_key = "";
    EXPECT_EQ(completed<Accepted>([&](auto done) { store_->accept(again, done); }).job.seq, 31)
        << "a number that was given once is not given again";
    EXPECT_EQ(run_sqlite(folder_.file(), "PRAGMA foreign_key_check"), "");
    EXPECT_EQ(run_sqlite(folder_.file(), "PRAGMA integrity_check"), "ok");
}

/// A file with one job in each table: "ended", "running" and "waiting".
class SqliteRules : public testing::Test {
protected:
    SqliteRules() {
        for (const char* id : {"ended", "running", "waiting"}) {
            NewJob job;
            job.id = id;
            completed<Accepted>([&](auto done) { store_->accept(job, done); });
        }
        const auto claimed = completed<std::vector<JobRecord>>([&](auto done) {
            store_->claim({"worker", 1, std::chrono::minutes(1), 2}, done);
        });
        const JobEnd end{claimed.at(0).seq, "ended", 1, JobStatus::succeeded, "{}", "", "1", 2};
        completed<bool>([&](auto done) { store_->finish(end, done); });
    }
    /// SQLite's error for that change; "" if it succeeds.
    std::string refusal(const std::string& change) {
        try {
            run_sqlite(folder_.file(), change);
        } catch (const std::exception& error) {
            return error.what();
        }
        return "";
    }
    void expect_nothing_changed() {
        EXPECT_EQ(store_->find("ended").value().status, JobStatus::succeeded);
        EXPECT_EQ(store_->find("ended").value().result, "{}");
        EXPECT_EQ(store_->find("running").value().status, JobStatus::running);
        EXPECT_EQ(store_->find("waiting").value().status, JobStatus::queued);
        EXPECT_EQ(store_->depth().single, 1U);
    }

    TemporaryFolder folder_;
    std::unique_ptr<JobStore> store_ = open_sqlite_store(folder_.file(), SchemaSteps::take);
};

TEST_F(SqliteRules, TheFileItselfRefusesWhatTheStatesDoNotAllow) {
    // By a rule of the table, not because the statement is not valid.
    const auto by_rule =
        testing::AnyOf(HasSubstr("constraint failed"), HasSubstr("does not change"), HasSubstr("is its worker's"));
    for (const char* change : kForbiddenChanges) EXPECT_THAT(refusal(change), by_rule) << change;
    expect_nothing_changed();
}

TEST_F(SqliteRules, AJobIsNeverInTwoPlaces) {
    const std::string waits = "INSERT INTO waiting (class, turn, seq, flow) SELECT class, turn, seq, flow ";
    const std::string runs =
        "INSERT INTO running (seq, class, turn, flow, worker, attempts, crashes, started_at) "
        "SELECT seq, class, turn, flow, 'worker', 2, 0, 1 ";
    const std::string ends =
        "INSERT INTO ended (seq, single, status, attempts, cancel_requested, finished_at) "
        "SELECT seq, TRUE, 'failed', 1, FALSE, 1 ";
    for (const std::string& change : {waits + "FROM jobs WHERE id = 'running'", waits + "FROM jobs WHERE id = 'ended'",
                                      runs + "FROM jobs WHERE id = 'ended'", ends + "FROM jobs WHERE id = 'running'"})
        EXPECT_THAT(refusal(change), HasSubstr("two places")) << change;
    expect_nothing_changed();
}

TEST_F(SqliteRules, AnEndStaysAsItIsAndARunIsItsWorkers) {
    for (const char* change : {"UPDATE ended SET result = '{\"x\":2}'", "UPDATE ended SET error = 'late'",
                               "UPDATE ended SET status = 'failed'", "UPDATE ended SET finished_at = 3"})
        EXPECT_THAT(refusal(change), HasSubstr("does not change")) << change;
    for (const char* change : {"UPDATE running SET worker = 'another'", "UPDATE running SET attempts = attempts + 1",
                               "UPDATE running SET seq = seq + 100"})
        EXPECT_THAT(refusal(change), HasSubstr("is its worker's")) << change;
    EXPECT_EQ(refusal("UPDATE running SET cancel_requested = TRUE, progress = '{}'"), "");
    expect_nothing_changed();
    EXPECT_TRUE(store_->find("running").value().cancel_requested);
}

}  // namespace
}  // namespace tunewright::server
