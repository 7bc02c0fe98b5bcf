#include "server/jobs/service.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <future>

#include "server/jobs/sweeper.h"
#include "server/random.h"
#include "server/store/open_store.h"
#include "server/store/sqlite/sqlite_store.h"

namespace tunewright::server {
namespace {

using testing::HasSubstr;
using Status = api::JobOutcome::Status;

/// A gate that tests open: computations wait at it instead of taking time.
class Gate {
public:
    void open() { promise_.set_value(); }
    /// False if the stop comes first.
    bool pass(const std::stop_token& stop) const {
        while (future_.wait_for(std::chrono::milliseconds(1)) != std::future_status::ready)
            if (stop.stop_requested()) return false;
        return true;
    }

private:
    std::promise<void> promise_;
    std::shared_future<void> future_ = promise_.get_future().share();
};

class JobServiceTest : public testing::Test {
protected:
    JobServiceTest() {
        std::string name = (std::filesystem::temp_directory_path() / "tunewright-jobs-XXXXXX").string();
        folder_ = ::mkdtemp(name.data());
        store_ = open_sqlite_store((folder_ / "jobs.db").string(), SchemaSteps::take);
    }
    ~JobServiceTest() override {
        if (service_) service_->drain(std::chrono::seconds(0));
        timer_.stop();
        store_.reset();
        service_.reset();
        std::filesystem::remove_all(folder_);
    }

    /// Jobs named by their request: "wait" stops at the gate, "throw" throws, "partial" keeps a design when stopped.
    api::JobOutcome compute(std::string_view request, const RunControl& control) {
        if (request == "throw") throw std::runtime_error("a fault of ours");
        if (request == "fail") return {Status::failed, "", R"({"type":"no-feasible-controller"})"};
        if (request == "wait" || request == "partial") {
            if (control.progress) control.progress({0.5, "tune", "Halfway.", {}});
            if (!gate_.pass(control.stop))
                return {Status::cancelled, request == "partial" ? R"({"partial":true})" : "", ""};
        }
        return {Status::succeeded, "{\"of\":\"" + std::string(request) + "\"}", ""};
    }

    void start(std::size_t workers = 1, std::size_t queue_limit = 100,
               const std::function<void(JobSettings&)>& change = {}) {
        JobSettings settings;
        settings.workers = workers;
        settings.queue_limit = queue_limit;
        settings.version = "1.2.3";
        settings.run = [this](const api::StoredRequest& request, const RunControl& control) {
            return compute(request.json, control);
        };
        settings.now = [this] { return ++now_; };
        if (change) change(settings);
        // The store may be about to call the earlier service: it is destroyed after the store.
        if (service_) earlier_.push_back(std::move(service_));
        service_ = std::make_unique<JobService>(*store_, timer_, settings);
        service_->start();
    }

    Submission submit(const std::string& request, double timeout_s = 60) {
        Order order;
        order.job.timeout_s = timeout_s;
        order.job.request_json = request;
        std::promise<Submission> promise;
        service_->submit(
            order, [&](Submission made) { promise.set_value(std::move(made)); }, [](const auto&) {});
        return promise.get_future().get();
    }

    JobRecord ended(const std::string& id) {
        std::promise<void> promise;
        service_->wait(id, std::chrono::seconds(60), [&](const auto&) { promise.set_value(); });
        promise.get_future().get();
        return service_->find(id).value().job;
    }

    /// Waits until its computation is at the gate.
    void until_running(const std::string& id) {
        while (!service_->find(id).value().progress) std::this_thread::yield();
    }

    CancelEffect cancel(const std::string& id) {
        std::promise<CancelEffect> promise;
        service_->cancel(id, [&](Outcome<CancelEffect> effect) { promise.set_value(std::get<CancelEffect>(effect)); });
        return promise.get_future().get();
    }

    std::string submit_and_cancel(const std::string& request) {
        const std::string id = submit(request).job.id;
        EXPECT_EQ(cancel(id), CancelEffect::cancelled);
        return id;
    }

    void pause(bool paused) {
        std::promise<void> done;
        service_->pause(paused, [&](const auto&) { done.set_value(); });
        done.get_future().get();
    }

    Gate gate_;
    std::filesystem::path folder_;
    std::atomic<UnixMs> now_ = 1000;
    Timer timer_;
    std::unique_ptr<JobStore> store_;
    std::unique_ptr<JobService> service_;
    std::vector<std::unique_ptr<JobService>> earlier_;
};

TEST_F(JobServiceTest, AJobIsComputedAndItsResultKept) {
    start();
    const Submission made = submit("a");
    EXPECT_EQ(made.kind, Submission::Kind::created);
    const JobRecord job = ended(made.job.id);
    EXPECT_EQ(job.status, JobStatus::succeeded);
    EXPECT_EQ(job.result, R"({"of":"a"})");
    EXPECT_EQ(job.attempts, 1);
    EXPECT_EQ(service_->queued(), 0U);
}

TEST_F(JobServiceTest, AStoreThatStallsForLongerThanALeaseTakesNoJobFromItsOnlyProcess) {
    using namespace std::chrono;
    start(1, 100, [](JobSettings& settings) {
        settings.lease = milliseconds(200);
        settings.poll = milliseconds(20);
        settings.now = [] { return duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count(); };
    });
    const std::string id = submit("wait").job.id;
    until_running(id);
    // On the store's own thread: nothing is written meanwhile, as on a disk that stalls.
    store_->cancel("nobody", 1, [](const auto&) { std::this_thread::sleep_for(milliseconds(700)); });
    std::this_thread::sleep_for(milliseconds(1000));
    EXPECT_EQ(store_->find(id).value().attempts, 1);
    gate_.open();
    const JobRecord job = ended(id);
    EXPECT_EQ(job.status, JobStatus::succeeded);
    EXPECT_EQ(job.attempts, 1);
}

TEST_F(JobServiceTest, AJobDuringWhichProcessesEndedRunsAloneAndTheOthersGoOn) {
    start(0);
    const std::string suspect = submit("suspect").job.id;
    service_->drain(std::chrono::seconds(0));
    // Two processes that claimed it have died.
    for (int i = 0; i < 2; i++) {
        std::promise<void> claimed;
        store_->claim({"gone", ++now_, std::chrono::milliseconds(0), 1}, [&](const auto&) { claimed.set_value(); });
        claimed.get_future().get();
        store_->recover(++now_, 10, "{}");
    }
    now_ += 1001;
    std::atomic<int> computing = 0, beside_suspect = 0;
    start(3, 100, [&](JobSettings& settings) {
        settings.poll = std::chrono::milliseconds(5);
        settings.run = [&](const api::StoredRequest& request, const RunControl&) {
            const int now = ++computing;
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            if (request.json == "suspect" && (now > 1 || computing > 1)) beside_suspect++;
            --computing;
            return api::JobOutcome{Status::succeeded, "{}", ""};
        };
    });
    std::vector<std::string> others;
    for (int i = 0; i < 20; i++) others.push_back(submit("other").job.id);
    for (const std::string& id : others) EXPECT_EQ(ended(id).status, JobStatus::succeeded);
    EXPECT_EQ(ended(suspect).status, JobStatus::succeeded);
    EXPECT_EQ(ended(suspect).attempts, 3);
    EXPECT_EQ(beside_suspect, 0);
    EXPECT_EQ(ended(submit("other").job.id).status, JobStatus::succeeded) << "it goes on";
}

TEST_F(JobServiceTest, AClockThatIsSetDeletesNothing) {
    start();
    const std::string id = submit("a").job.id;
    ended(id);
    const Retention second{std::chrono::seconds(1), std::chrono::seconds(1), std::chrono::seconds(1)};
    Sweeper sweeper(*store_, second, [this] { return now_.load(); });
    const auto swept = [&] {
        std::this_thread::sleep_for(sweeper.sweep());
        std::this_thread::sleep_for(std::chrono::milliseconds(1100));
        sweeper.sweep();
        std::this_thread::sleep_for(std::chrono::milliseconds(200));
        return !store_->find(id);
    };
    EXPECT_FALSE(swept()) << "it is young";
    now_ += 8 * 24 * 3600 * 1000LL;
    EXPECT_FALSE(swept());
    // A service that starts with that clock has seen no jump, and waits as long as after one.
    Retention week{std::chrono::hours(7 * 24), {}, {}};
    Sweeper fresh(*store_, week, [this] { return now_.load(); });
    EXPECT_GT(fresh.sweep(), std::chrono::minutes(59));
    EXPECT_TRUE(store_->find(id));
    Sweeper brief(*store_, second, [this] { return now_.load(); });
    while (store_->find(id)) std::this_thread::sleep_for(brief.sweep());
}

TEST_F(JobServiceTest, WhatTheComputationRefusesIsAFailedJobWithItsError) {
    start();
    const JobRecord job = ended(submit("fail").job.id);
    EXPECT_EQ(job.status, JobStatus::failed);
    EXPECT_EQ(job.error, R"({"type":"no-feasible-controller"})");
}

TEST_F(JobServiceTest, AFaultFailsItsJobAloneAndTellsNothingOfOurInsides) {
    start();
    const JobRecord job = ended(submit("throw").job.id);
    EXPECT_EQ(job.status, JobStatus::failed);
    EXPECT_THAT(job.error, HasSubstr("internal"));
    EXPECT_THAT(job.error, testing::Not(HasSubstr("a fault of ours")));
    EXPECT_EQ(ended(submit("a").job.id).status, JobStatus::succeeded);
}

TEST_F(JobServiceTest, ARunningJobShowsItsProgressAndAnEndedOneNone) {
    start();
    const std::string id = submit("wait").job.id;
    until_running(id);
    while (service_->find(id)->progress.value_or(Progress{}).fraction < 0.5) std::this_thread::yield();
    EXPECT_EQ(service_->find(id)->progress->message, "Halfway.");
    gate_.open();
    ended(id);
    EXPECT_FALSE(service_->find(id)->progress);
}

TEST_F(JobServiceTest, ATimeOutStopsTheComputationAndIsTheCauseOfTheFailure) {
    start();
    const JobRecord job = ended(submit("wait", 0.02).job.id);
    EXPECT_EQ(job.status, JobStatus::failed);
    EXPECT_THAT(job.error, HasSubstr("timeout"));
    EXPECT_EQ(job.result, "");
}

TEST_F(JobServiceTest, ATimeOutKeepsTheDesignThatWasFound) {
    start();
    const JobRecord job = ended(submit("partial", 0.02).job.id);
    EXPECT_EQ(job.status, JobStatus::failed);
    EXPECT_THAT(job.error, HasSubstr("timeout"));
    EXPECT_EQ(job.result, R"({"partial":true})");
}

TEST_F(JobServiceTest, CancellingStopsARunningJobAndKeepsTheDesignThatWasFound) {
    start();
    const std::string id = submit("partial").job.id;
    until_running(id);
    EXPECT_EQ(cancel(id), CancelEffect::requested);
    const JobRecord job = ended(id);
    EXPECT_EQ(job.status, JobStatus::cancelled);
    EXPECT_EQ(job.result, R"({"partial":true})");
    EXPECT_EQ(job.error, "");
}

TEST_F(JobServiceTest, CancellingAQueuedJobTellsWhoWaitsForIt) {
    start();
    const std::string running = submit("wait").job.id;
    const std::string queued = submit("a").job.id;
    until_running(running);
    std::promise<void> notified;
    service_->wait(queued, std::chrono::seconds(60), [&](const auto&) { notified.set_value(); });
    EXPECT_EQ(cancel(queued), CancelEffect::cancelled);
    notified.get_future().get();
    EXPECT_EQ(service_->queued(), 0U);
    gate_.open();
    EXPECT_EQ(ended(running).status, JobStatus::succeeded);
    EXPECT_EQ(service_->find(queued)->job.status, JobStatus::cancelled);
}

TEST_F(JobServiceTest, AFullQueueRefusesAndTakesAgainWhenThereIsRoom) {
    start(1, 2);
    const std::string running = submit("wait").job.id;
    until_running(running);
    submit("a");
    const std::string last = submit("b").job.id;
    EXPECT_EQ(submit("c").kind, Submission::Kind::queue_full);
    gate_.open();
    EXPECT_EQ(ended(last).status, JobStatus::succeeded);
    EXPECT_EQ(submit("c").kind, Submission::Kind::created);
}

TEST_F(JobServiceTest, AWaitThatIsOverIsToldWhileTheJobRuns) {
    start();
    const std::string id = submit("wait").job.id;
    std::promise<void> notified;
    service_->wait(id, std::chrono::milliseconds(5), [&](const auto&) { notified.set_value(); });
    notified.get_future().get();
    EXPECT_FALSE(has_ended(service_->find(id)->job.status));
}

TEST_F(JobServiceTest, WaitingForAnEndedOrUnknownJobIsToldAtOnce) {
    start();
    const std::string id = submit("a").job.id;
    ended(id);
    for (const std::string& asked : {id, std::string("nothing")}) {
        std::promise<void> notified;
        service_->wait(asked, std::chrono::hours(1), [&](const auto&) { notified.set_value(); });
        notified.get_future().get();
    }
}

TEST_F(JobServiceTest, WhileTheQueueIsPausedRunningJobsEndAndNoneIsBegun) {
    start();
    const std::string running = submit("wait").job.id;
    until_running(running);
    pause(true);
    const std::string waiting = submit("a").job.id;
    gate_.open();
    EXPECT_EQ(ended(running).status, JobStatus::succeeded);
    EXPECT_EQ(ended(submit_and_cancel("b")).attempts, 0);
    EXPECT_EQ(store_->find(waiting)->status, JobStatus::queued);
    pause(false);
    EXPECT_EQ(ended(waiting).status, JobStatus::succeeded) << "at once: nothing else has to arrive";
}

TEST_F(JobServiceTest, AJobThatIsQueuedAgainIsComputedAgain) {
    start();
    const std::string id = submit("fail").job.id;
    EXPECT_EQ(ended(id).attempts, 1);
    std::promise<RequeueEffect> effect;
    service_->requeue(id, [&](const auto& outcome) { effect.set_value(std::get<RequeueEffect>(outcome)); });
    EXPECT_EQ(effect.get_future().get(), RequeueEffect::requeued);
    const JobRecord job = ended(id);
    EXPECT_EQ(job.status, JobStatus::failed);
    EXPECT_EQ(job.attempts, 2);
}

TEST_F(JobServiceTest, DrainingLetsARunningJobEndAndTakesNoMore) {
    start();
    const std::string id = submit("wait").job.id;
    until_running(id);
    auto drained = std::async(std::launch::async, [&] { return service_->drain(std::chrono::hours(1)); });
    while (!service_->draining()) std::this_thread::yield();
    EXPECT_EQ(submit("a").kind, Submission::Kind::draining);
    gate_.open();
    EXPECT_TRUE(drained.get());
    EXPECT_EQ(store_->find(id)->status, JobStatus::succeeded);
}

TEST_F(JobServiceTest, DrainingWithoutGraceGivesRunningJobsBackToTheQueueAndTellsWhoWaits) {
    start();
    const std::string id = submit("partial").job.id;
    until_running(id);
    std::promise<void> notified;
    service_->wait(id, std::chrono::hours(1), [&](const auto&) { notified.set_value(); });
    EXPECT_TRUE(service_->drain(std::chrono::seconds(0)));
    notified.get_future().get();
    EXPECT_EQ(store_->find(id)->status, JobStatus::queued);
    EXPECT_EQ(store_->find(id)->attempts, 1);
}

TEST_F(JobServiceTest, JobsLeftBehindByAnEarlierProcessAreTakenUp) {
    start();
    const std::string running = submit("wait").job.id;
    until_running(running);
    const std::string queued = submit("a").job.id;
    service_->drain(std::chrono::seconds(0));
    gate_.open();
    start(2);
    EXPECT_EQ(ended(running).attempts, 2);
    EXPECT_EQ(ended(queued).attempts, 1);
}

TEST_F(JobServiceTest, ManyWorkersEndEachOfManyJobsOnce) {
    start(4, 10'000);
    std::vector<std::string> ids;
    for (int i = 0; i < 300; i++) ids.push_back(submit("job" + std::to_string(i)).job.id);
    for (std::size_t i = 0; i < ids.size(); i++) {
        const JobRecord job = ended(ids[i]);
        EXPECT_EQ(job.status, JobStatus::succeeded);
        EXPECT_EQ(job.attempts, 1);
        EXPECT_EQ(job.result, "{\"of\":\"job" + std::to_string(i) + "\"}");
    }
}

TEST(JobId, IsLongRandomAndOfLettersAndDigits) {
    const std::string a = new_id();
    EXPECT_EQ(a.size(), 26U);
    EXPECT_EQ(a.find_first_not_of("0123456789abcdefghjkmnpqrstvwxyz"), std::string::npos);
    EXPECT_NE(a, new_id());
}

}  // namespace
}  // namespace tunewright::server
