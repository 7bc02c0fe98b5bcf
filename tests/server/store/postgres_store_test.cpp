#include "server/store/open_store.h"

#include <condition_variable>
#include <mutex>
#include <thread>

#include "server/store/postgres/postgres_store.h"
#include "tests/server/store/forbidden_changes.h"
#include "tests/server/store/postgres_fixture.h"

namespace tunewright::server {
namespace {

class PostgresPlace : public StorePlace {
public:
    explicit PostgresPlace(std::unique_ptr<PostgresDatabase> database) : database_(std::move(database)) {}
    std::unique_ptr<JobStore> open() override { return open_postgres_store(database_->url(), SchemaSteps::take); }

private:
    std::unique_ptr<PostgresDatabase> database_;
};

std::unique_ptr<StorePlace> postgres_place() {
    std::unique_ptr<PostgresDatabase> database = PostgresDatabase::make();
    if (!database) return nullptr;
    return std::make_unique<PostgresPlace>(std::move(database));
}

INSTANTIATE_TEST_SUITE_P(Postgres, StoreConformance, testing::Values(MakePlace(postgres_place)));

TEST_F(PostgresStore, ReplicasMayStartTogether) {
    std::vector<std::unique_ptr<JobStore>> stores(4);
    {
        std::vector<std::jthread> starts;
        for (auto& store : stores) starts.emplace_back([&] { store = open(); });
    }
    for (const auto& store : stores) EXPECT_TRUE(store->shared() && store->healthy());
    EXPECT_EQ(database_->run("SELECT count(*) = max(step) FROM tunewright.schema_steps"), "t");
}

TEST_F(PostgresStore, WhatWasToComeLaterThanItCanHasBeenWrittenBeforeTheClockWasSetBack) {
    const auto store = open();
    for (const char* id : {"runs", "paused"}) accept(*store, id);
    ASSERT_EQ(claim(*store).size(), 1U);
    database_->run(
        "SET search_path TO tunewright; UPDATE workers SET lease_until = clock_timestamp(); "
        "UPDATE upkeep SET done_at = clock_timestamp() + interval '1 day'; "
        "UPDATE waiting SET attempts = 2, crashes = 2, not_before = clock_timestamp() + interval '1 day'");
    const Reclaim often{2000, 10, "", true, std::chrono::minutes(1)};
    EXPECT_EQ(completed<Recovery>([&](auto done) { store->reclaim(often, done); }).interrupted, 1U);
    EXPECT_EQ(store->depth().suspects, 1U);
    const Claim suspects{"worker", 2000, std::chrono::minutes(10), 1, true};
    EXPECT_EQ(completed<std::vector<JobRecord>>([&](auto done) { store->claim(suspects, done); }).size(), 1U);
}

TEST_F(PostgresStore, TwoProcessesShareTheJobsAndNeverTheSame) {
    const auto one = open();
    const auto two = open();
    constexpr std::size_t count = 300;
    for (std::size_t i = 0; i < count; i++) one->accept(job("job" + std::to_string(i)), [](const auto&) {});
    accept(*one, "last");
    std::mutex mutex;
    std::multiset<std::string> ids;
    const auto work = [&](JobStore& store) {
        for (auto claimed = claim(store, 3); !claimed.empty(); claimed = claim(store, 3)) {
            const std::lock_guard lock(mutex);
            for (const JobRecord& record : claimed) ids.insert(record.id);
        }
    };
    {
        const std::jthread a([&] { work(*one); });
        const std::jthread b([&] { work(*two); });
    }
    EXPECT_EQ(ids.size(), count + 1);
    EXPECT_EQ(std::set<std::string>(ids.begin(), ids.end()).size(), count + 1);
}

TEST_F(PostgresStore, NoticesGoToOtherProcessesAndNotToOneself) {
    struct Heard {
        std::mutex mutex;
        std::condition_variable changed;
        std::set<std::string> notices;
        void add(const StoreNotice& notice) {
            const std::lock_guard lock(mutex);
            notices.insert(std::to_string(static_cast<int>(notice.kind)) + notice.id);
            changed.notify_all();
        }
        void wait_for(StoreNotice::Kind kind, const std::string& id) {
            std::unique_lock lock(mutex);
            changed.wait(lock, [&] { return notices.contains(std::to_string(static_cast<int>(kind)) + id); });
        }
    } here, there;
    const auto one = open();
    const auto two = open();
    one->watch([&](const StoreNotice& notice) { here.add(notice); });
    two->watch([&](const StoreNotice& notice) { there.add(notice); });
    accept(*one, "a");
    there.wait_for(StoreNotice::Kind::queued, "");
    const std::int64_t seq = claim(*one).at(0).seq;
    const Heartbeat beat{"worker", 2000, std::chrono::minutes(1), {{seq, "a", 1, R"({"stage":"x"})"}}};
    completed<std::vector<Holding>>([&](auto done) { one->beat(beat, done); });
    there.wait_for(StoreNotice::Kind::progress, "a");
    completed<CancelEffect>([&](auto done) { one->cancel("a", 3000, done); });
    there.wait_for(StoreNotice::Kind::cancel, "a");
    const JobEnd end{seq, "a", 1, JobStatus::cancelled, "", "{}", "1", 3000};
    completed<bool>([&](auto done) { one->finish(end, done); });
    there.wait_for(StoreNotice::Kind::ended, "a");
    accept(*two, "b");
    here.wait_for(StoreNotice::Kind::queued, "");
    EXPECT_EQ(here.notices.size(), 1U) << "only what the other did";
}

TEST_F(PostgresStore, AConnectionThatWasLostIsReplacedBeforeAnybodyNotices) {
    const auto store = open();
    accept(*store, "a");
    EXPECT_TRUE(store->find("a"));
    database_->cut_connections();
    EXPECT_TRUE(accept(*store, "b"));
    EXPECT_TRUE(store->find("a"));
    wait_until_healthy(*store);
}

TEST_F(PostgresStore, WithoutADatabaseItFailsAndTellsAndComesBack) {
    const auto store = open();
    accept(*store, "a");
    database_->allow_connections(false);
    EXPECT_THROW(accept(*store, "b"), std::runtime_error);
    EXPECT_THROW(store->find("a"), StoreError);
    EXPECT_FALSE(store->healthy());
    database_->allow_connections(true);
    wait_until_healthy(*store);  // automatically, without any call
    EXPECT_TRUE(store->find("a"));
    EXPECT_TRUE(accept(*store, "c"));
}

TEST_F(PostgresStore, WhatIsReportedAsAcceptedIsThereHoweverOftenConnectionsBreak) {
    const auto store = open();
    std::vector<std::string> accepted;
    for (int wave = 0; wave < 10; wave++) {
        std::vector<std::promise<Outcome<Accepted>>> answers(40);
        for (std::size_t i = 0; i < answers.size(); i++)
            store->accept(job(std::to_string(wave) + "-" + std::to_string(i)),
                          [&answers, i](auto outcome) { answers[i].set_value(std::move(outcome)); });
        database_->cut_connections();
        for (auto& answer : answers) {
            const Outcome<Accepted> outcome = answer.get_future().get();
            if (const auto* made = std::get_if<Accepted>(&outcome)) accepted.push_back(made->job.id);
        }
        wait_until_healthy(*store);
    }
    EXPECT_TRUE(accept(*store, "last"));
    for (const std::string& id : accepted) EXPECT_TRUE(store->find(id)) << id;
    EXPECT_EQ(database_->run("SELECT count(*) = count(DISTINCT id) FROM tunewright.jobs"), "t");
}

/// Changes that affect every database of the cluster: no other test may run at the same time (see
/// tests/CMakeLists.txt). A commit that notifies holds a lock of the whole cluster, so that one in another database
/// would delay it.
class PostgresCluster : public PostgresStore {
protected:
    void TearDown() override {
        if (database_) stop_waiting_for_standbys();
    }
    /// From now on a commit waits forever, after it has become durable.
    void wait_for_standbys() const {
        database_->run("ALTER SYSTEM SET synchronous_standby_names = 'nobody'");
        database_->run("SELECT pg_reload_conf()");
        // Commits wait once the checkpointer has read the setting, which a checkpoint of another database may delay.
        wait_until("SELECT current_setting('synchronous_standby_names') = 'nobody'");
        database_->run("CHECKPOINT");
    }
    void stop_waiting_for_standbys() const {
        database_->run("ALTER SYSTEM RESET synchronous_standby_names");
        database_->run("SELECT pg_reload_conf()");
    }
};

TEST_F(PostgresCluster, ACommitWhoseAnswerWasLostIsFoundOutAndNotDoneTwice) {
    const auto store = open();
    accept(*store, "a");
    wait_for_standbys();
    std::promise<Outcome<std::vector<JobRecord>>> claimed;
    std::promise<Outcome<Accepted>> accepted;
    store->accept(job("b"), [&](auto outcome) { accepted.set_value(std::move(outcome)); });
    store->claim({"worker", 2000, std::chrono::minutes(10), 1},
                 [&](auto outcome) { claimed.set_value(std::move(outcome)); });
    const std::string waiting = " FROM pg_stat_activity WHERE wait_event = 'SyncRep' AND datname = current_database()";
    wait_until("SELECT count(*) > 0" + waiting);
    database_->run("SELECT pg_terminate_backend(pid)" + waiting);
    stop_waiting_for_standbys();
    const Outcome<Accepted> outcome = accepted.get_future().get();
    ASSERT_TRUE(std::holds_alternative<Accepted>(outcome)) << std::get<StoreFault>(outcome).detail;
    EXPECT_EQ(std::get<Accepted>(outcome).kind, Accepted::Kind::created);
    EXPECT_EQ(std::get<std::vector<JobRecord>>(claimed.get_future().get()).size(), 1U);
    EXPECT_EQ(database_->run("SELECT count(*) FROM tunewright.jobs WHERE id = 'b'"), "1");
    EXPECT_EQ(database_->run("SELECT sum(attempts) FROM tunewright.running"), "1");
    EXPECT_EQ(database_->run("SELECT count(*) FROM tunewright.waiting"), "1");
}

TEST_F(PostgresStore, ACommitThatWasCutOffIsDoneAgain) {
    const auto store = open();
    database_->run(
        "CREATE FUNCTION slow() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN PERFORM pg_sleep(60); RETURN NULL; END $$;"
        "CREATE CONSTRAINT TRIGGER slow AFTER INSERT ON tunewright.jobs DEFERRABLE INITIALLY DEFERRED FOR EACH ROW "
        "EXECUTE FUNCTION slow()");
    std::promise<Outcome<Accepted>> accepted;
    store->accept(job("a"), [&](auto outcome) { accepted.set_value(std::move(outcome)); });
    const std::string asleep = " FROM pg_stat_activity WHERE wait_event = 'PgSleep' AND datname = current_database()";
    wait_until("SELECT count(*) > 0" + asleep);
    database_->run(
        "CREATE OR REPLACE FUNCTION slow() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN RETURN NULL; END $$");
    database_->run("SELECT pg_terminate_backend(pid)" + asleep);
    const Outcome<Accepted> outcome = accepted.get_future().get();
    ASSERT_TRUE(std::holds_alternative<Accepted>(outcome)) << std::get<StoreFault>(outcome).detail;
    EXPECT_EQ(database_->run("SELECT count(*) FROM tunewright.jobs WHERE id = 'a'"), "1");
}

TEST_F(PostgresStore, ACommitThatNobodyCanAskAboutIsSaidToBeUnknown) {
    const auto store = open();
    database_->run(
        "CREATE FUNCTION slow() RETURNS trigger LANGUAGE plpgsql AS $$ BEGIN PERFORM pg_sleep(60); RETURN NULL; END $$;"
        "CREATE CONSTRAINT TRIGGER slow AFTER INSERT ON tunewright.jobs DEFERRABLE INITIALLY DEFERRED FOR EACH ROW "
        "EXECUTE FUNCTION slow()");
    std::promise<Outcome<Accepted>> accepted;
    store->accept(job("a"), [&](auto outcome) { accepted.set_value(std::move(outcome)); });
    wait_until(
        "SELECT count(*) > 0 FROM pg_stat_activity WHERE wait_event = 'PgSleep' AND datname = current_database()");
    database_->allow_connections(false);
    const Outcome<Accepted> outcome = accepted.get_future().get();
    ASSERT_TRUE(std::holds_alternative<StoreFault>(outcome));
    EXPECT_EQ(std::get<StoreFault>(outcome).kind, StoreFault::Kind::unknown);
    database_->allow_connections(true);
}

TEST_F(PostgresStore, WithoutNoticesItStaysHealthyAndAcceptsJobs) {
    const auto store = open();
    EXPECT_TRUE(accept(*store, "a"));
    // No new connections are allowed, and the listening one is cut; those that write and read stay.
    EXPECT_EQ(database_->run("UPDATE pg_database SET datallowconn = false WHERE datname = current_database();"
                             "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE query LIKE 'LISTEN%' AND "
                             "datname = current_database()"),
              "t");
    for (int i = 0; i < 5; i++) {
        EXPECT_TRUE(accept(*store, "b" + std::to_string(i)));
        EXPECT_TRUE(store->healthy());
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    database_->allow_connections(true);
}

TEST_F(PostgresStore, ADatabaseOfANewerProgramIsLeftAlone) {
    open().reset();
    database_->run("INSERT INTO tunewright.schema_steps (step) VALUES (99)");
    try {
        open();
        FAIL() << "it was opened";
    } catch (const StoreError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("schema 99 of a newer program"));
    }
}

TEST_F(PostgresStore, TheDatabaseItselfRefusesWhatTheStatesDoNotAllow) {
    const auto store = open();
    for (const char* id : {"ended", "running", "waiting"}) accept(*store, id);
    const JobEnd end{claim(*store, 2).at(0).seq, "ended", 1, JobStatus::succeeded, "{}", "", "1", 3000};
    completed<bool>([&](auto done) { store->finish(end, done); });
    for (const char* change : kForbiddenChanges) {
        std::string refusal = "it was done";
        try {
            database_->run(std::string("SET search_path TO tunewright; ") + change);
        } catch (const std::exception& error) {
            refusal = error.what();
        }
        EXPECT_THAT(refusal, testing::HasSubstr("constraint")) << "not by a rule of the table: " << change;
    }
    EXPECT_EQ(store->find("ended").value().status, JobStatus::succeeded);
    EXPECT_EQ(store->find("running").value().status, JobStatus::running);
    EXPECT_EQ(store->find("waiting").value().status, JobStatus::queued);
}

TEST_F(PostgresStore, NoMessageHasThePasswordInIt) {
    const auto message_of = [](const std::string& url) -> std::string {
        try {
            open_postgres_store(url, SchemaSteps::take);
        } catch (const StoreError& error) {
            return error.what();
        }
        return "it was opened";
    };
    const std::string unreadable = message_of("postgresql://me:top/secret@127.0.0.1/db");
    EXPECT_THAT(unreadable, testing::HasSubstr("cannot be read"));
    EXPECT_THAT(unreadable, testing::Not(testing::HasSubstr("secret")));
    for (const char* url :
         {"postgresql://me:12/secret@host/db", "postgresql://me:a@secret@host/db", "postgresql://me:%secret@host/db"})
        EXPECT_EQ(message_of(url), unreadable);
    const std::string closed = message_of("postgresql://me:topsecret@127.0.0.1:1/db");
    EXPECT_THAT(closed, testing::HasSubstr("Cannot open the store postgresql://127.0.0.1:1/db"));
    EXPECT_THAT(closed, testing::Not(testing::HasSubstr("topsecret")));
    std::string wrong = database_->url();
    wrong.replace(wrong.find(':', 13) + 1, 4, "topsecret");
    EXPECT_THAT(message_of(wrong), testing::HasSubstr("password"));
    EXPECT_THAT(message_of(wrong), testing::Not(testing::HasSubstr("topsecret")));
}

}  // namespace
}  // namespace tunewright::server
