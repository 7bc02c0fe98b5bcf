#include "server/jobs/followers.h"

#include <gmock/gmock.h>

#include <condition_variable>
#include <filesystem>
#include <future>

#include "server/store/open_store.h"
#include "server/store/sqlite/sqlite_store.h"

namespace tunewright::server {
namespace {

using Kind = JobNews::Kind;
using namespace std::chrono_literals;

/// Stores the news of one follower.
class Ear {
public:
    Followers::Listener listener() {
        return [this](const JobNews& news) {
            const std::lock_guard lock(mutex_);
            news_.push_back(news);
            changed_.notify_all();
        };
    }
    /// The next news, in order.
    JobNews next() {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [this] { return news_.size() > heard_; });
        return news_[heard_++];
    }
    std::size_t count() {
        const std::lock_guard lock(mutex_);
        return news_.size();
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<JobNews> news_;
    std::size_t heard_ = 0;
};

class FollowersTest : public testing::Test {
protected:
    FollowersTest() {
        std::string name = (std::filesystem::temp_directory_path() / "tunewright-follow-XXXXXX").string();
        folder_ = ::mkdtemp(name.data());
        store_ = open_sqlite_store((folder_ / "jobs.db").string(), SchemaSteps::take);
        store_->recover(0, 10, "");
        followers_ = std::make_unique<Followers>(*store_, held_, outage_, 10ms);
    }
    ~FollowersTest() override {
        followers_.reset();
        store_.reset();
        std::filesystem::remove_all(folder_);
    }

    template <class T, class Start>
    static T done(Start start) {
        std::promise<T> promise;
        start([&](Outcome<T> outcome) { promise.set_value(std::get<T>(std::move(outcome))); });
        return promise.get_future().get();
    }
    void accept(const std::string& id) {
        NewJob job;
        job.id = id;
        job.request = "{}";
        done<Accepted>([&](auto callback) { store_->accept(job, callback); });
    }
    JobRecord claim() {
        return done<std::vector<JobRecord>>([&](auto callback) {
                   store_->claim({"worker", 0, 10s, 1}, callback);
               })
            .at(0);
    }
    void finish(const JobRecord& job) {
        done<bool>([&](auto callback) {
            store_->finish({job.seq, job.id, job.attempts, JobStatus::succeeded, "{\"of\":1}", "", "1", 5}, callback);
        });
    }

    std::filesystem::path folder_;
    HeldJobs held_;
    StoreOutageLog outage_;
    std::unique_ptr<JobStore> store_;
    std::unique_ptr<Followers> followers_;
};

TEST_F(FollowersTest, AWaitingJobIsToldAtOnceThenItsStartItsProgressAndItsEnd) {
    accept("a");
    Ear ear;
    followers_->follow("a", ear.listener());
    EXPECT_EQ(ear.next().view->job.status, JobStatus::queued);
    // Claimed by another process, which reports its progress through the store.
    const JobRecord job = claim();
    EXPECT_EQ(ear.next().view->job.status, JobStatus::running);
    done<std::vector<Holding>>([&](auto callback) {
        store_->beat({"worker", 0, 10s, {{job.seq, "a", 1, R"({"fraction":0.5})"}}}, callback);
    });
    EXPECT_EQ(ear.next().view->job.progress, R"({"fraction":0.5})");
    finish(job);
    const JobNews last = ear.next();
    EXPECT_EQ(last.kind, Kind::ended);
    EXPECT_EQ(last.view->job.result, "{\"of\":1}");
    EXPECT_EQ(followers_->count(), 0U);
}

TEST_F(FollowersTest, ProgressOfAJobOfThisProcessNeedsNoStore) {
    accept("a");
    const auto held = held_.add(claim(), true);
    held->enter(HeldJob::Stage::computing);
    Ear ear;
    followers_->follow("a", ear.listener());
    EXPECT_FALSE(ear.next().view->progress);
    held->report({0.25, "tune", "A quarter.", {}});
    EXPECT_EQ(ear.next().view->progress->fraction, 0.25);
}

TEST_F(FollowersTest, WhatDoesNotChangeIsToldOnce) {
    accept("a");
    accept("b");
    Ear a;
    Ear b;
    followers_->follow("a", a.listener());
    a.next();
    // Checked repeatedly, and after a notice.
    followers_->changed("a");
    followers_->follow("b", b.listener());
    b.next();
    done<CancelEffect>([&](auto callback) { store_->cancel("b", 0, callback); });
    EXPECT_EQ(b.next().kind, Kind::ended);
    EXPECT_EQ(a.count(), 1U);
}

TEST_F(FollowersTest, WhoComesLaterHearsHowTheJobStandsAndOthersNothing) {
    accept("a");
    Ear first;
    Ear second;
    followers_->follow("a", first.listener());
    first.next();
    followers_->follow("a", second.listener());
    EXPECT_EQ(second.next().view->job.status, JobStatus::queued);
    EXPECT_EQ(first.count(), 1U);
}

TEST_F(FollowersTest, EndedUnknownAndDeletedJobsAreTheLastNews) {
    accept("a");
    finish(claim());
    Ear ended;
    followers_->follow("a", ended.listener());
    EXPECT_EQ(ended.next().kind, Kind::ended);
    Ear unknown;
    followers_->follow("b", unknown.listener());
    EXPECT_EQ(unknown.next().kind, Kind::gone);
    EXPECT_EQ(followers_->count(), 0U);
}

TEST_F(FollowersTest, ClosingTellsEverybodyNowAndLater) {
    accept("a");
    Ear before;
    Ear after;
    followers_->follow("a", before.listener());
    before.next();
    followers_->close();
    EXPECT_EQ(before.next().kind, Kind::closing);
    followers_->follow("a", after.listener());
    EXPECT_EQ(after.next().kind, Kind::closing);
}

TEST_F(FollowersTest, WhoLeavesIsForgotten) {
    accept("a");
    Ear gone;
    Ear there;
    const auto key = followers_->follow("a", gone.listener());
    gone.next();
    followers_->leave(key);
    followers_->follow("a", there.listener());
    there.next();
    claim();
    EXPECT_EQ(there.next().view->job.status, JobStatus::running);
    EXPECT_EQ(gone.count(), 1U);
    EXPECT_EQ(followers_->count(), 1U);
}

}  // namespace
}  // namespace tunewright::server
