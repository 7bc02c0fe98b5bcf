// The SQLite store on a disk that fails at any one of its calls, or that loses power: what was reported is there, what
// was refused is not, and the file is whole.
#include <gtest/gtest.h>

#include <map>
#include <mutex>

#include "server/store/open_store.h"
#include "tests/server/store/faulty/disk.h"
#include "tests/server/store/store_conformance.h"
#include "tests/server/store/store_file.h"

namespace tunewright::server {
namespace {

using Fault = FaultyDisk::Fault;

/// In memory where that can be: a disk would take minutes to make durable what these tests write.
std::string scratch() {
    const bool memory = std::filesystem::is_directory("/dev/shm");
    return memory ? "/dev/shm" : std::filesystem::temp_directory_path().string();
}

/// A store's caller who keeps book of what was reported to him.
class Bookkeeper {
public:
    explicit Bookkeeper(JobStore& store) : store_(store) {}

    /// A job of everybody's life: accepted, claimed, ended; every third is deleted.
    void live(int number) {
        const std::string id = "job" + std::to_string(number);
        NewJob job;
        job.id = id;
        job.request.assign(3000 + 500 * static_cast<std::size_t>(number % 7), 'x');
        if (!reported<Accepted>([&](auto done) { store_.accept(job, done); })) return;
        there_[id] = JobStatus::queued;
        const auto claimed = reported<std::vector<JobRecord>>([&](auto done) {
            store_.claim({"worker", 1, std::chrono::minutes(1), 1}, done);
        });
        for (const JobRecord& one : claimed.value_or(std::vector<JobRecord>())) {
            const JobEnd end{one.seq, one.id, one.attempts, JobStatus::succeeded, std::string(4000, 'r'), "", "1", 2};
            if (reported<bool>([&](auto callback) { store_.finish(end, callback); }).value_or(false))
                there_[one.id] = JobStatus::succeeded;
            const auto gone = number % 3 == 0
                                  ? reported<RemoveEffect>([&](auto callback) { store_.remove(one.id, callback); })
                                  : std::nullopt;
            if (gone == RemoveEffect::removed) there_.erase(one.id);
        }
    }

    /// What was reported, and since when it may be only better.
    const std::map<std::string, JobStatus>& there() const { return there_; }

private:
    /// Nothing where the store could not do it.
    template <class T, class Start>
    std::optional<T> reported(Start start) {
        std::promise<Outcome<T>> promise;
        start([&](Outcome<T> outcome) { promise.set_value(std::move(outcome)); });
        Outcome<T> outcome = promise.get_future().get();
        if (auto* value = std::get_if<T>(&outcome)) return std::move(*value);
        return std::nullopt;
    }

    JobStore& store_;
    std::map<std::string, JobStatus> there_;
};

/// Every job that was reported is there, and as far on as was reported.
void expect_kept(const std::string& file, const std::map<std::string, JobStatus>& there, const std::string& where) {
    ASSERT_EQ(run_sqlite(file, "PRAGMA integrity_check"), "ok") << where;
    const auto store = open_sqlite_store(file, SchemaSteps::take);
    store->recover(1, 10, "{}");
    for (const auto& [id, status] : there) {
        const auto found = store->find(id);
        ASSERT_TRUE(found) << id << " is lost " << where;
        if (status == JobStatus::succeeded) {
            EXPECT_EQ(found->result.size(), 4000U) << id << " " << where;
        }
    }
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
        expect_kept(folder.file(), there, "at call " + std::to_string(number));
    }
    EXPECT_GT(points, 60);
    RecordProperty("points", points);
}

INSTANTIATE_TEST_SUITE_P(Each, SqliteFaults,
                         testing::Values(Fault::write, Fault::short_write, Fault::full, Fault::sync));

/// After each call that made something durable the machine loses power: what is on the disk then is what is left.
TEST(SqlitePowerLoss, LosesNothingThatWasReported) {
    const TemporaryFolder folder(scratch()), left(scratch());
    FaultyDisk disk;
    struct Moment {
        std::string file;
        std::map<std::string, JobStatus> there;
    };
    std::vector<Moment> moments;
    std::mutex mutex;
    std::map<std::string, JobStatus> reported;
    const auto store = open_sqlite_store(folder.file(), SchemaSteps::take);
    store->recover(1, 10, "{}");
    disk.on_sync([&] {
        const std::string file = (left.path() / ("moment" + std::to_string(moments.size()) + ".db")).string();
        for (const char* part : {"", "-wal"})
            if (std::filesystem::exists(folder.file() + part))
                std::filesystem::copy_file(folder.file() + part, file + part);
        const std::lock_guard lock(mutex);
        moments.push_back({file, reported});
    });
    Bookkeeper keeper(*store);
    for (int i = 0; i < 60; ++i) {
        keeper.live(i);
        const std::lock_guard lock(mutex);
        reported = keeper.there();
        // What is deleted may come back: the deletion was reported, but a copy from before does not know it.
    }
    disk.on_sync({});
    ASSERT_GT(moments.size(), 100U);
    for (const Moment& moment : moments) {
        // A torn page: what the log of changes has last was not written to its end.
        if (std::filesystem::exists(moment.file + "-wal")) {
            const auto size = std::filesystem::file_size(moment.file + "-wal");
            std::filesystem::resize_file(moment.file + "-wal", size);
        }
        expect_kept(moment.file, moment.there, "in " + moment.file);
    }
}

}  // namespace
}  // namespace tunewright::server
