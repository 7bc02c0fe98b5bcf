// The SQLite store on a disk that fails at any one of its calls, or that loses power: reported results exist, refused
// ones do not, and the file is intact.
#include <gtest/gtest.h>

#include <map>
#include <mutex>
#include <random>

#include "server/store/open_store.h"
#include "server/store/sqlite/sqlite_store.h"
#include "tests/server/store/faulty/bookkeeper.h"
#include "tests/server/store/faulty/disk.h"
#include "tests/server/store/store_conformance.h"
#include "tests/server/store/store_file.h"

namespace tunewright::server {
namespace {

using Fault = FaultyDisk::Fault;

/// Checks that every reported job exists when the file is opened again.
void expect_kept_in(const std::string& file, const std::map<std::string, JobStatus>& there, const std::string& where) {
    ASSERT_EQ(run_sqlite(file, "PRAGMA integrity_check"), "ok") << where;
    const auto store = open_sqlite_store(file, SchemaSteps::take);
    store->recover(1, 10, "{}");
    expect_kept(*store, there, where);
}

class SqliteFaults : public testing::TestWithParam<Fault> {};

TEST_P(SqliteFaults, AtAnyCallLoseNothing) {
    constexpr int jobs = 5;
    std::int64_t calls = 0;
    int points = 0;
    for (std::int64_t number = 0; number == 0 || number < calls; ++number, ++points) {
        const TemporaryFolder folder(scratch());
        FaultyDisk disk;
        std::map<std::string, JobStatus> there;
        {
            const auto store = open_sqlite_store(folder.file(), SchemaSteps::take);
            store->recover(1, 10, "{}");
            disk.fail(number, GetParam());
            Bookkeeper keeper(*store);
            for (int i = 0; i < jobs; ++i) keeper.live(i);
            calls = std::max(calls, disk.calls());
            disk.fail(-1, Fault::none);
            keeper.live(jobs);
            EXPECT_TRUE(keeper.there().contains("job" + std::to_string(jobs)) || jobs % 3 == 0) << number;
            there = keeper.there();
        }
        expect_kept_in(folder.file(), there, "at call " + std::to_string(number));
    }
    EXPECT_GT(points, 60);
    RecordProperty("points", points);
}

INSTANTIATE_TEST_SUITE_P(Each, SqliteFaults,
                         testing::Values(Fault::write, Fault::short_write, Fault::full, Fault::sync));

/// The machine loses power after any one of its calls: any part of the data that was not synced may remain.
TEST(SqlitePowerLoss, LosesNothingThatWasReported) {
    constexpr int jobs = 40, max = 500;
    struct Moment {
        std::filesystem::path folder;
        std::map<std::string, JobStatus> there;
    };
    const TemporaryFolder folder(scratch()), left(scratch());
    FaultyDisk disk;
    std::mutex mutex;
    std::vector<Moment> moments;
    std::map<std::string, JobStatus> reported;
    std::mt19937 random(7);
    {
        const auto store = open_sqlite_store(folder.file(), SchemaSteps::take);
        store->recover(1, 10, "{}");
        disk.after_each([&] {
            const std::lock_guard lock(mutex);
            if (moments.size() == max) return;
            Moment moment{left.path() / std::to_string(moments.size()), reported};
            std::filesystem::create_directory(moment.folder);
            const unsigned share = static_cast<unsigned>(moments.size() % 3);  // none, some, or nearly all of it
            disk.lose_power(moment.folder, [&] { return random() % 16 < 1 + 7 * share; });
            moments.push_back(std::move(moment));
        });
        Bookkeeper keeper(*store);
        for (int i = 0; i < jobs; ++i) {
            keeper.live(i);
            const std::lock_guard lock(mutex);
            reported = keeper.there();
        }
        disk.after_each({});
    }
    EXPECT_EQ(moments.size(), max);
    for (const Moment& moment : moments)
        expect_kept_in((moment.folder / "jobs.db").string(), moment.there, "in " + moment.folder.string());
}

}  // namespace
}  // namespace tunewright::server
