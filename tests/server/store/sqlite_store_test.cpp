#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include "server/store/open_store.h"
#include "server/store/sqlite/sqlite_store.h"
#include "tests/server/store/store_conformance.h"
#include "tests/server/store/store_file.h"

namespace tunewright::server {
namespace {

class SqlitePlace : public StorePlace {
public:
    std::unique_ptr<JobStore> open() override { return open_sqlite_store(folder_.file(), SchemaSteps::take); }

private:
    TemporaryFolder folder_;
};

std::unique_ptr<StorePlace> sqlite_place() { return std::make_unique<SqlitePlace>(); }

INSTANTIATE_TEST_SUITE_P(Sqlite, StoreConformance, testing::Values(MakePlace(sqlite_place)));

TEST(SqliteStore, TwoServicesCannotOpenTheSameFile) {
    const TemporaryFolder folder;
    const auto first = open_sqlite_store(folder.file(), SchemaSteps::take);
    try {
        open_sqlite_store(folder.file(), SchemaSteps::take);
        FAIL() << "the second one was opened";
    } catch (const StoreError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("another tunewright is using it"));
    }
}

TEST(SqliteStore, AFileOfANewerProgramIsLeftAlone) {
    const TemporaryFolder folder;
    open_sqlite_store(folder.file(), SchemaSteps::take).reset();
    {
        // SQLite keeps user_version as a big-endian number at offset 60 of the file.
        std::fstream file(folder.file(), std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(60);
        file.write("\0\0\0\x63", 4);
    }
    try {
        open_sqlite_store(folder.file(), SchemaSteps::take);
        FAIL() << "it was opened";
    } catch (const StoreError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("schema 99 of a newer program"));
    }
}

TEST(SqliteStore, AJobWhosePauseIsLongerThanAnyIsHandedOutAsTheClockWasSetBack) {
    const TemporaryFolder folder;
    const auto store = open_sqlite_store(folder.file(), SchemaSteps::take);
    NewJob job;
    job.id = "twice";
    job.request = "{}";
    completed<Accepted>([&](auto done) { store->accept(job, done); });
    const UnixMs now = wall_clock(), day = 86'400'000;
    const auto claim = [&](UnixMs at, bool suspects) {
        const Claim asked{"worker", at, std::chrono::milliseconds(0), 1, suspects};
        return completed<std::vector<JobRecord>>([&](auto done) { store->claim(asked, done); }).size();
    };
    for (int crash = 0; crash < 2; crash++) {
        ASSERT_EQ(claim(now + day, false), 1U);
        completed<Recovery>([&](auto done) { store->reclaim({now + day, 10, ""}, done); });
    }
    EXPECT_EQ(claim(now + day, true), 0U) << "its pause is not over";
    EXPECT_EQ(store->depth().suspects, 1U);
    EXPECT_EQ(claim(now, true), 1U);
}

TEST(SqliteStore, AFailedWriteIsToldAndTheStoreRecovers) {
    const TemporaryFolder folder;
    const auto store = open_sqlite_store(folder.file(), SchemaSteps::take);
    NewJob job;
    job.id = "big";
    job.request.assign(4 * 1024 * 1024, 'x');
    // A limit on the size of files simulates the disk: writing beyond it fails.
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit old{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &old), 0);
    const rlimit small{1024 * 1024, old.rlim_max};
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
    std::promise<Outcome<Accepted>> promise;
    store->accept(job, [&](Outcome<Accepted> outcome) { promise.set_value(std::move(outcome)); });
    const Outcome<Accepted> outcome = promise.get_future().get();
    ::setrlimit(RLIMIT_FSIZE, &old);
    ASSERT_TRUE(std::holds_alternative<StoreFault>(outcome));
    EXPECT_EQ(std::get<StoreFault>(outcome).kind, StoreFault::Kind::full);
    EXPECT_FALSE(store->find("big"));
    while (!store->healthy()) std::this_thread::sleep_for(std::chrono::milliseconds(5));  // it checks automatically

    const auto accepted = completed<Accepted>([&](auto done) { store->accept(job, done); });
    EXPECT_EQ(accepted.kind, Accepted::Kind::created);
    EXPECT_TRUE(store->healthy());
}

TEST(SqliteStore, OneBadChangeDoesNotTakeTheOthersOfItsGroupWithIt) {
    const TemporaryFolder folder;
    const auto store = open_sqlite_store(folder.file(), SchemaSteps::take);
    NewJob job;
    job.request = "{}";
    job.id = "twice";
    std::vector<std::promise<bool>> created(20);
    for (std::size_t i = 0; i < created.size(); i++) {
        // The same id repeatedly between good ones: the table refuses it.
        job.id = i % 2 == 0 ? "twice" : "job" + std::to_string(i);
        store->accept(job, [&created, i](const Outcome<Accepted>& outcome) {
            created[i].set_value(std::holds_alternative<Accepted>(outcome));
        });
    }
    int made = 0;
    for (auto& promise : created) made += promise.get_future().get() ? 1 : 0;
    EXPECT_EQ(made, 11);
    EXPECT_EQ(store->list({}).jobs.size(), 11U);
}

TEST(SqliteStore, NothingIsWrittenWhereNoJobIsDue) {
    const TemporaryFolder folder;
    const auto store = open_sqlite_store(folder.file(), SchemaSteps::take);
    sqlite3* other = nullptr;
    ASSERT_EQ(sqlite3_open(folder.file().c_str(), &other), SQLITE_OK);
    ASSERT_EQ(sqlite3_exec(other, "BEGIN IMMEDIATE", nullptr, nullptr, nullptr), SQLITE_OK);
    EXPECT_EQ(completed<std::size_t>([&](auto done) { store->start_due(wall_clock(), done); }), 0U)
        << "while another writes";
    sqlite3_close(other);
}

}  // namespace
}  // namespace tunewright::server
