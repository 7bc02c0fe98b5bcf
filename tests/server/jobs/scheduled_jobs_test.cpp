// Scheduled jobs, unique jobs and the limit of jobs per client, in the service of a process.
#include <gmock/gmock.h>

#include <filesystem>
#include <future>
#include <thread>

#include "server/jobs/service.h"
#include "server/store/open_store.h"
#include "server/store/sqlite/sqlite_store.h"
#include "tests/server/store/shared_store.h"

namespace tunewright::server {
namespace {

using namespace std::chrono_literals;

class ScheduledJobs : public testing::Test {
protected:
    ScheduledJobs() {
        std::string name = (std::filesystem::temp_directory_path() / "tunewright-scheduled-XXXXXX").string();
        folder_ = ::mkdtemp(name.data());
        store_ = open_sqlite_store((folder_ / "jobs.db").string(), SchemaSteps::take);
        settings_.now = [this] {
            const UnixMs shift = shift_;
            return wall_clock() + shift;
        };
        settings_.poll = 20ms;
        settings_.run = [this](const api::StoredRequest& request, const RunControl& control) {
            begun_at_ = wall_clock();
            while (request.json == "long" && !control.stop.stop_requested()) std::this_thread::sleep_for(1ms);
            return api::JobOutcome{api::JobOutcome::Status::succeeded, "{}", ""};
        };
        settings_.observer.limited = [this] { limited_++; };
    }
    ~ScheduledJobs() override {
        if (service_) service_->drain(0s);
        timer_.stop();
        store_.reset();
        service_.reset();
        std::filesystem::remove_all(folder_);
    }

    JobService& start() {
        service_ = std::make_unique<JobService>(*store_, timer_, settings_);
        service_->start();
        return *service_;
    }

    Submission submit(const api::PreparedJob& job, const std::string& flow = "") {
        Order order;
        order.job = job;
        order.flow = flow;
        std::promise<Submission> promise;
        service_->submit(
            order, [&](Submission made) { promise.set_value(std::move(made)); }, [](const auto&) {});
        return promise.get_future().get();
    }
    static api::PreparedJob request(const std::string& json, std::optional<UnixMs> not_before = std::nullopt) {
        api::PreparedJob job;
        job.request_json = json;
        job.request_hash = "hash of " + json;
        job.not_before = not_before;
        return job;
    }
    JobRecord ended(const std::string& id) {
        std::promise<void> promise;
        service_->wait(id, 60s, [&](const auto&) { promise.set_value(); });
        promise.get_future().get();
        return service_->find(id).value().job;
    }

    std::filesystem::path folder_;
    std::atomic<UnixMs> shift_ = 0, begun_at_ = 0;
    std::atomic<int> limited_ = 0;
    JobSettings settings_;
    Timer timer_;
    std::unique_ptr<JobStore> store_;
    std::unique_ptr<JobService> service_;
};

TEST_F(ScheduledJobs, AJobBeginsAtItsTimeAndNotBefore) {
    start();
    const UnixMs time = wall_clock() + 300;
    const Submission made = submit(request("a", time));
    EXPECT_EQ(made.job.not_before, time);
    EXPECT_EQ(service_->queued(), 1U);
    EXPECT_EQ(ended(made.job.id).status, JobStatus::succeeded);
    EXPECT_GE(begun_at_, time);
    EXPECT_LT(begun_at_, time + 5000) << "half a second on a quiet machine";
}

TEST_F(ScheduledJobs, ATimeInThePastMeansAtOnce) {
    start();
    const Submission made = submit(request("a", wall_clock() - 1000));
    EXPECT_FALSE(made.job.not_before);
    EXPECT_EQ(ended(made.job.id).status, JobStatus::succeeded);
}

TEST_F(ScheduledJobs, AJobThatCameDueWhileNoProcessRanBeginsWithTheNext) {
    start();
    const std::string id = submit(request("a", wall_clock() + 3'600'000)).job.id;
    service_->drain(0s);
    const std::unique_ptr<JobService> earlier = std::move(service_);
    shift_ = 2 * 3'600'000;
    start();
    EXPECT_EQ(ended(id).attempts, 1);
    service_->drain(0s);
    timer_.stop();
    store_.reset();
}

/// Reservations are released by exceptions: memory may be exhausted anywhere between the place in the queue and the
/// store.
TEST_F(ScheduledJobs, APlaceInTheQueueIsGivenBackWhereThereIsNoMemoryForTheJob) {
    struct OutOfMemory : SharedStore {
        using SharedStore::SharedStore;
        void accept(NewJob, Done<Accepted> done) override {
            const Done<Accepted> dropped = std::move(done);
            throw std::bad_alloc();
        }
        void requeue(std::string, Done<RequeueEffect>) override { throw std::bad_alloc(); }
    };
    settings_.queue_limit = 2;
    start();
    const std::string failed = submit(request("a", wall_clock() + 3'600'000)).job.id;
    std::promise<void> cancelled;
    service_->cancel(failed, [&](const auto&) { cancelled.set_value(); });
    cancelled.get_future().get();
    NoticeBoard board;
    OutOfMemory store(*store_, board);
    JobService service(store, timer_, settings_);
    for (int i = 0; i < 5; i++) {
        Order order;
        order.job = request("a");
        EXPECT_THROW(service.submit(
                         order, [](const Submission&) {}, [](const auto&) {}),
                     std::bad_alloc);
        EXPECT_THROW(service.requeue(failed, [](const auto&) {}), std::bad_alloc);
    }
    EXPECT_EQ(service.queued(), 0U);
}

TEST_F(ScheduledJobs, AUniqueJobIsMadeOnce) {
    start();
    api::PreparedJob job = request("long");
    job.unique = true;
    const std::string id = submit(job).job.id;
    const Submission again = submit(job);
    EXPECT_EQ(again.kind, Submission::Kind::existing);
    EXPECT_EQ(again.job.id, id);
    EXPECT_EQ(submit(request("other")).kind, Submission::Kind::created);
    EXPECT_EQ(submit(request("long")).kind, Submission::Kind::created) << "it does not ask to be unique";
}

TEST_F(ScheduledJobs, OneClientCannotHaveMoreJobsUnderWayThanItMay) {
    settings_.client_jobs = 2;
    start();
    EXPECT_EQ(submit(request("long"), "x").kind, Submission::Kind::created);
    const std::string waits = submit(request("a", wall_clock() + 3'600'000), "x").job.id;
    EXPECT_EQ(submit(request("b"), "x").kind, Submission::Kind::too_many);
    EXPECT_EQ(limited_, 1);
    EXPECT_EQ(submit(request("b"), "y").kind, Submission::Kind::created);
    std::promise<void> cancelled;
    service_->cancel(waits, [&](const auto&) { cancelled.set_value(); });
    cancelled.get_future().get();
    EXPECT_EQ(submit(request("b"), "x").kind, Submission::Kind::created);
    EXPECT_EQ(submit(request("b"), "x").kind, Submission::Kind::too_many);
    EXPECT_EQ(limited_, 2);
}

}  // namespace
}  // namespace tunewright::server
