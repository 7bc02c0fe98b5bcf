// A file system without room: reported as such, readable as before, and fully usable once there is room again.
#include <sys/mount.h>

#include <fstream>
#include <sstream>
#include <thread>

#include "server/store/open_store.h"
#include "server/store/sqlite/sqlite_store.h"
#include "tests/server/store/store_conformance.h"
#include "tests/server/store/store_file.h"

namespace tunewright::server {
namespace {

constexpr const char* kNoMount =
    "a small file system needs the right to mount one: run script/test as root, in a container with CAP_SYS_ADMIN";

/// A file system in memory with this number of kilobytes, if this process may mount one.
class SmallDisk {
public:
    explicit SmallDisk(const std::filesystem::path& path) : path_(path) {
        mounted_ = ::mount("tmpfs", path_.c_str(), "tmpfs", 0, "size=2048k") == 0;
    }
    ~SmallDisk() {
        if (mounted_) ::umount(path_.c_str());
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;
    bool mounted() const { return mounted_; }
    void grow() const { EXPECT_EQ(::mount("tmpfs", path_.c_str(), "tmpfs", MS_REMOUNT, "size=32768k"), 0); }

private:
    std::filesystem::path path_;
    bool mounted_ = false;
};

TEST(SqliteDiskFull, AcceptsFailAsFullReadsGoOnAndNothingIsLostWhenThereIsRoomAgain) {
    const TemporaryFolder folder;
    const SmallDisk disk(folder.path());
    if (!disk.mounted()) GTEST_SKIP() << kNoMount;
    std::vector<std::string> accepted;
    {
        const auto store = open_sqlite_store(folder.file(), SchemaSteps::take);
        store->recover(1, 10, "{}");
        std::optional<StoreFault> fault;
        while (!fault) {
            NewJob job;
            job.id = "job" + std::to_string(accepted.size());
            job.request.assign(20'000, 'x');
            std::promise<Outcome<Accepted>> answer;
            store->accept(job, [&](Outcome<Accepted> outcome) { answer.set_value(std::move(outcome)); });
            const Outcome<Accepted> outcome = answer.get_future().get();
            if (const auto* refused = std::get_if<StoreFault>(&outcome))
                fault = *refused;
            else
                accepted.push_back(job.id);
        }
        EXPECT_EQ(fault->kind, StoreFault::Kind::full) << fault->detail;
        ASSERT_GT(accepted.size(), 5U);
        for (const std::string& id : accepted) EXPECT_EQ(store->find(id).value().request.size(), 20'000U);

        disk.grow();
        while (!store->healthy()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
        const auto claimed = completed<std::vector<JobRecord>>([&](auto callback) {
            store->claim({"worker", 1, std::chrono::minutes(1), 1}, callback);
        });
        ASSERT_EQ(claimed.size(), 1U);
        const JobEnd end{claimed[0].seq, claimed[0].id, 1, JobStatus::succeeded, std::string(100'000, 'r'), "", "1", 2};
        EXPECT_TRUE(completed<bool>([&](auto callback) { store->finish(end, callback); }));
        EXPECT_EQ(store->find(claimed[0].id).value().result.size(), 100'000U);
    }
    EXPECT_EQ(run_sqlite(folder.file(), "PRAGMA integrity_check"), "ok");
    EXPECT_EQ(run_sqlite(folder.file(), "SELECT count(*) FROM jobs"), std::to_string(accepted.size()));
}

TEST(SqliteDiskFull, IsNotHealthyForAsLongAsOnlySmallChangesFit) {
    const TemporaryFolder folder;
    const SmallDisk disk(folder.path());
    if (!disk.mounted()) GTEST_SKIP() << kNoMount;
    const auto store = open_sqlite_store(folder.file(), SchemaSteps::take);
    const auto accept = [&](const std::string& id, std::size_t bytes) {
        NewJob job;
        job.id = id;
        job.request.assign(bytes, 'x');
        std::promise<bool> kept;
        store->accept(
            job, [&](const Outcome<Accepted>& outcome) { kept.set_value(std::holds_alternative<Accepted>(outcome)); });
        return kept.get_future().get();
    };
    ASSERT_TRUE(accept("small", 10));
    ASSERT_FALSE(accept("large", 4'000'000));
    for (int i = 0; i < 30; i++) {
        ASSERT_TRUE(accept("small" + std::to_string(i), 10));
        ASSERT_FALSE(store->healthy());
        std::this_thread::sleep_for(std::chrono::milliseconds(50));  // free space is checked twice a second
    }
    disk.grow();
    while (!store->healthy()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_TRUE(accept("large", 4'000'000));
}

TEST(SqliteDiskFull, AnEndThatFoundNoRoomIsTakenWhenItIsOfferedAgain) {
    const TemporaryFolder folder;
    const SmallDisk disk(folder.path());
    if (!disk.mounted()) GTEST_SKIP() << kNoMount;
    const auto store = open_sqlite_store(folder.file(), SchemaSteps::take);
    NewJob job;
    job.id = "a";
    completed<Accepted>([&](auto callback) { store->accept(job, callback); });
    const auto claimed = completed<std::vector<JobRecord>>([&](auto callback) {
        store->claim({"worker", 1, std::chrono::minutes(1), 1}, callback);
    });
    const JobEnd end{claimed.at(0).seq, "a", 1, JobStatus::succeeded, std::string(4'000'000, 'r'), "", "1", 2};
    std::promise<Outcome<bool>> answer;
    store->finish(end, [&](Outcome<bool> outcome) { answer.set_value(std::move(outcome)); });
    const Outcome<bool> refused = answer.get_future().get();
    ASSERT_TRUE(std::holds_alternative<StoreFault>(refused));
    EXPECT_EQ(std::get<StoreFault>(refused).kind, StoreFault::Kind::full);
    EXPECT_EQ(store->find("a").value().status, JobStatus::running);
    disk.grow();
    EXPECT_TRUE(completed<bool>([&](auto callback) { store->finish(end, callback); }));
    EXPECT_EQ(store->find("a").value().result, end.result);
}

TEST(SqliteDiskFull, TheSchemaIsBroughtUpToDateAndTheFileWrittenAnewWithTheRoomOfTheReserve) {
    const TemporaryFolder folder;
    const SmallDisk disk(folder.path());
    if (!disk.mounted()) GTEST_SKIP() << kNoMount;
    {
        const auto store = open_sqlite_store(folder.file(), SchemaSteps::take);
        NewJob job;
        job.id = "a";
        completed<Accepted>([&](auto callback) { store->accept(job, callback); });
    }
    {
        std::ofstream filler(folder.path() / "filler", std::ios::binary);
        const std::string page(4096, 'x');
        while (filler.write(page.data(), static_cast<std::streamsize>(page.size())).flush()) {
        }
    }
    std::ostringstream said;
    EXPECT_NO_THROW(migrate_sqlite(folder.file(), true, said));
    EXPECT_EQ(said.str().find("The schema is at step"), said.str().rfind("The schema is at step")) << said.str();
    EXPECT_NE(said.str().find("The file has"), std::string::npos) << said.str();
    EXPECT_EQ(run_sqlite(folder.file(), "SELECT count(*) FROM jobs"), "1");
}

}  // namespace
}  // namespace tunewright::server
