// Several services on one store: their effects on each other, and the jobs of a service that is gone.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <future>

#include "server/jobs/service.h"
#include "server/store/open_store.h"
#include "server/store/sqlite/sqlite_store.h"
#include "tests/server/store/shared_store.h"

namespace tunewright::server {
namespace {

using testing::HasSubstr;
using Status = api::JobOutcome::Status;
using namespace std::chrono_literals;

constexpr UnixMs kLease = 60'000;  // on the tests' own clock, which changes only when a test moves it

/// A service with a name, its view of the store, and a gate at which its long jobs wait.
class Process {
public:
    Process(JobStore& store, NoticeBoard& board, Timer& timer, const std::atomic<UnixMs>& now, std::string name,
            std::size_t workers, JobSettings settings = {})
        : view(store, board), name_(std::move(name)) {
        settings.name = name_;
        settings.workers = workers;
        settings.poll = 10ms;
        settings.lease = std::chrono::milliseconds(kLease);
        settings.version = "1.2.3";
        settings.now = [&now] { return now.load(); };
        settings.run = [this](const api::StoredRequest& request, const RunControl& control) {
            return compute(request.json, control);
        };
        settings.observer.dropped = [this] { dropped++; };
        jobs = std::make_unique<JobService>(view, timer, settings);
        jobs->start();
    }

    void open_gate() { open_ = true; }
    /// Requests in the order in which they were begun.
    std::vector<std::string> computed() {
        const std::lock_guard lock(mutex_);
        return computed_;
    }

    SharedStore view;
    std::unique_ptr<JobService> jobs;
    std::atomic<int> dropped = 0;
    std::atomic<int> waiting = 0;  ///< computations at the gate

private:
    /// Requests that begin with "long" wait at the gate; "deaf" ones ignore a stop.
    api::JobOutcome compute(std::string_view request, const RunControl& control) {
        {
            const std::lock_guard lock(mutex_);
            computed_.emplace_back(request);
        }
        if (request.starts_with("long") || request.starts_with("deaf")) {
            control.progress({0.5, "tune", "Halfway at " + name_ + ".", {}});
            waiting++;
            while (!open_ && (request.starts_with("deaf") || !control.stop.stop_requested()))
                std::this_thread::sleep_for(1ms);
            waiting--;
            if (!open_) return {Status::cancelled, R"({"by":"a stop"})", ""};
        }
        return {Status::succeeded, "{\"by\":\"" + name_ + "\"}", ""};
    }

    std::string name_;
    std::atomic<bool> open_ = false;
    std::mutex mutex_;
    std::vector<std::string> computed_;
};

class SharedJobs : public testing::Test {
protected:
    SharedJobs() {
        std::string name = (std::filesystem::temp_directory_path() / "tunewright-shared-XXXXXX").string();
        folder_ = ::mkdtemp(name.data());
        store_ = open_sqlite_store((folder_ / "jobs.db").string(), SchemaSteps::take);
        store_->recover(now_, 10, "");
    }
    ~SharedJobs() override {
        for (const auto& process : processes_) process->open_gate();
        for (const auto& process : processes_) {
            process->view.broken = process->view.mute = process->view.lossy = false;
            process->jobs->drain(0s);
        }
        timer_.stop();
        store_.reset();
        processes_.clear();
        std::filesystem::remove_all(folder_);
    }

    Process& add(const std::string& name, std::size_t workers, JobSettings settings = {}) {
        processes_.push_back(
            std::make_unique<Process>(*store_, board_, timer_, now_, name, workers, std::move(settings)));
        return *processes_.back();
    }

    static Submission submit(Process& to, const std::string& request, double timeout_s = 60) {
        Order order;
        order.job.request_json = request;
        order.job.timeout_s = timeout_s;
        std::promise<Submission> promise;
        to.jobs->submit(
            order, [&](Submission made) { promise.set_value(std::move(made)); }, [](const auto&) {});
        return promise.get_future().get();
    }
    static std::string post(Process& to, const std::string& request) { return submit(to, request).job.id; }

    static JobRecord ended(Process& at, const std::string& id) {
        std::promise<void> promise;
        at.jobs->wait(id, 60s, [&](const auto&) { promise.set_value(); });
        promise.get_future().get();
        return at.jobs->find(id).value().job;
    }

    static void cancel(Process& at, const std::string& id) {
        std::promise<void> promise;
        at.jobs->cancel(id, [&](const auto&) { promise.set_value(); });
        promise.get_future().get();
    }

    /// Twenty entries whose requests begin with this text.
    void add_batch(const std::string& request) {
        std::promise<void> opened;
        store_->open_batch({"batch", "", "", "", now_}, [&](const auto&) { opened.set_value(); });
        opened.get_future().get();
        std::vector<NewEntry> entries;
        for (int i = 0; i < 20; i++) {
            NewEntry entry;
            entry.index = i;
            entry.id = "entry" + std::to_string(i);
            entry.request = request + entry.id;
            entries.push_back(entry);
        }
        std::promise<void> added;
        store_->add_entries("batch", entries, now_, [&](const auto&) { added.set_value(); });
        added.get_future().get();
    }

    static void until(const std::function<bool()>& holds) {
        while (!holds()) std::this_thread::sleep_for(1ms);
    }

    std::filesystem::path folder_;
    std::atomic<UnixMs> now_ = 1'000'000;
    Timer timer_;
    NoticeBoard board_;
    std::unique_ptr<JobStore> store_;
    std::vector<std::unique_ptr<Process>> processes_;
};

TEST_F(SharedJobs, AServiceWithoutWorkersTakesJobsThatOthersEndAndTellsWhoWaits) {
    Process& api = add("api", 0);
    add("worker", 1);
    const JobRecord job = ended(api, post(api, "a"));
    EXPECT_EQ(job.status, JobStatus::succeeded);
    EXPECT_EQ(job.result, R"({"by":"worker"})");
    EXPECT_EQ(api.view.claims, 0);
}

TEST_F(SharedJobs, NothingDependsOnNotices) {
    Process& api = add("api", 0);
    Process& worker = add("worker", 1);
    api.view.deaf = worker.view.deaf = true;
    EXPECT_EQ(ended(api, post(api, "a")).status, JobStatus::succeeded);
    const std::string running = post(api, "long");
    until([&] { return worker.waiting == 1; });
    cancel(api, running);
    EXPECT_EQ(ended(api, running).status, JobStatus::cancelled);
}

TEST_F(SharedJobs, ACancelStopsAJobThatRunsElsewhereAndKeepsItsDesign) {
    Process& api = add("api", 0);
    Process& worker = add("worker", 1);
    const std::string id = post(api, "long");
    until([&] { return worker.waiting == 1; });
    cancel(api, id);
    const JobRecord job = ended(api, id);
    EXPECT_EQ(job.status, JobStatus::cancelled);
    EXPECT_EQ(job.result, R"({"by":"a stop"})");
}

TEST_F(SharedJobs, ProgressOfAJobThatRunsElsewhereIsShown) {
    Process& api = add("api", 0);
    add("worker", 1);
    const std::string id = post(api, "long");
    until([&] { return !api.jobs->find(id)->job.progress.empty(); });
    EXPECT_THAT(api.jobs->find(id)->job.progress, HasSubstr("Halfway at worker."));
    EXPECT_FALSE(api.jobs->find(id)->progress);
}

TEST_F(SharedJobs, JobsOfADeadServiceEndOnAnother) {
    Process& dead = add("dead", 1);
    const std::string id = post(dead, "long");
    until([&] { return dead.waiting == 1; });
    dead.view.mute = true;
    Process& heir = add("heir", 1);
    heir.open_gate();
    now_ += kLease + 1;
    const JobRecord job = ended(heir, id);
    EXPECT_EQ(job.result, R"({"by":"heir"})");
    EXPECT_EQ(job.attempts, 2);
}

TEST_F(SharedJobs, AWorkerThatWasThoughtDeadEndsNothing) {
    Process& slow = add("slow", 1);
    const std::string id = post(slow, "deaf");
    until([&] { return slow.waiting == 1; });
    slow.view.mute = true;
    Process& heir = add("heir", 1);
    now_ += kLease + 1;
    until([&] { return heir.waiting == 1; });
    // It returns, computes to the end and offers its result while the other computes.
    slow.open_gate();
    slow.view.mute = false;
    until([&] { return slow.dropped == 1; });
    EXPECT_EQ(store_->find(id)->status, JobStatus::running);
    heir.open_gate();
    const JobRecord job = ended(slow, id);
    EXPECT_EQ(job.result, R"({"by":"heir"})");
    EXPECT_EQ(heir.dropped, 0);
}

TEST_F(SharedJobs, AWorkerThatLearnsThatItsJobIsAnothersStops) {
    Process& slow = add("slow", 1);
    post(slow, "long");
    until([&] { return slow.waiting == 1; });
    slow.view.mute = true;
    Process& heir = add("heir", 1);
    now_ += kLease + 1;
    until([&] { return heir.waiting == 1; });
    slow.view.mute = false;
    until([&] { return slow.waiting == 0; });
    until([&] { return slow.dropped == 1; });
    EXPECT_EQ(slow.jobs->running(), 0U);
}

TEST_F(SharedJobs, AJobWhoseClaimWasNeverAnsweredIsGivenBackByItsWorkerItself) {
    Process& process = add("process", 2);
    const std::string running = post(process, "long");
    until([&] { return process.waiting == 1; });
    process.view.lossy = true;
    const std::string stray = post(process, "a");
    until([&] { return store_->find(stray)->status == JobStatus::running; });
    process.view.lossy = false;
    // In steps that are not a jump of the clock, each with a heartbeat: no lease ever expires.
    for (UnixMs end = now_ + kLease + 1; now_ <= end;) {
        now_ += kLease / 5;
        until([&] { return process.view.last_beat == now_.load(); });
    }
    EXPECT_EQ(ended(process, stray).status, JobStatus::succeeded);
    EXPECT_EQ(store_->find(stray)->attempts, 2);
    EXPECT_EQ(store_->find(running)->attempts, 1) << "what it knows of it keeps";
    EXPECT_EQ(process.dropped, 0);
}

TEST_F(SharedJobs, AJobThatIsInterruptedTooOftenFailsWithTheReason) {
    JobSettings settings;
    settings.max_attempts = 2;
    Process& watcher = add("watcher", 0, settings);
    const std::string id = post(watcher, "long");
    for (int i = 0; i < 2; i++) {
        Process& dead = add("dead" + std::to_string(i), 1, settings);
        until([&] { return dead.waiting == 1; });
        dead.view.mute = true;
        now_ += kLease + 1;
    }
    const JobRecord job = ended(watcher, id);
    EXPECT_EQ(job.status, JobStatus::failed);
    EXPECT_EQ(job.attempts, 2);
    EXPECT_THAT(job.error, HasSubstr("interrupted 2 times"));
    EXPECT_THAT(job.error, HasSubstr("\"type\":\"internal\""));
}

TEST_F(SharedJobs, DrainingGivesRunningJobsToTheOthers) {
    Process& leaving = add("leaving", 1);
    const std::string id = post(leaving, "long");
    until([&] { return leaving.waiting == 1; });
    Process& staying = add("staying", 1);
    staying.open_gate();
    EXPECT_TRUE(leaving.jobs->drain(0s));
    EXPECT_EQ(ended(staying, id).result, R"({"by":"staying"})");
}

TEST_F(SharedJobs, LongJobsAreNeverHoarded) {
    Process& first = add("first", 1);
    std::vector<std::string> ids;
    for (int i = 0; i < 6; i++) ids.push_back(post(first, "long" + std::to_string(i)));
    until([&] { return first.waiting == 1; });
    Process& second = add("second", 2);
    until([&] { return second.waiting == 2; });
    EXPECT_EQ(first.jobs->running(), 1U);
    EXPECT_EQ(second.jobs->running(), 2U);
    EXPECT_EQ(store_->depth().single, 3U);
}

TEST_F(SharedJobs, ManyShortJobsOfTwoServicesEndOnceEach) {
    Process& first = add("first", 2);
    Process& second = add("second", 2);
    std::vector<std::string> ids;
    for (int i = 0; i < 300; i++) ids.push_back(post(i % 2 == 0 ? first : second, "job" + std::to_string(i)));
    for (const std::string& id : ids) {
        const JobRecord job = ended(second, id);
        EXPECT_EQ(job.status, JobStatus::succeeded);
    }
    EXPECT_EQ(first.computed().size() + second.computed().size(), 300U);
    EXPECT_EQ(first.dropped + second.dropped, 0);
}

TEST_F(SharedJobs, ResultsThatTheStoreCannotTakeAreKeptUntilItCan) {
    Process& process = add("process", 1);
    const std::string id = post(process, "long");
    const std::string next = post(process, "a");
    until([&] { return process.waiting == 1; });
    process.view.broken = true;
    EXPECT_EQ(submit(process, "b").kind, Submission::Kind::store_failed);
    process.open_gate();
    until([&] { return process.waiting == 0; });
    const int reclaims = process.view.reclaims;
    const int claims = process.view.claims;
    until([&] { return process.view.reclaims >= reclaims + 5; });
    // No busy loop: a claim is repeated with the upkeep, not earlier.
    EXPECT_LE(process.view.claims, claims + 8);
    EXPECT_EQ(store_->find(id)->status, JobStatus::running);
    process.view.broken = false;
    EXPECT_EQ(ended(process, id).result, R"({"by":"process"})");
    EXPECT_EQ(ended(process, next).status, JobStatus::succeeded);
}

TEST_F(SharedJobs, EndedJobsAreSweptWhenTheirRetentionIsOver) {
    JobSettings settings;
    settings.retention = {60s, 60s, 60s};
    Process& process = add("process", 1, settings);
    const std::string old = post(process, "old");
    ended(process, old);
    now_ += 61'000;
    const std::string young = post(process, "young");
    ended(process, young);
    // The sweep at the start of a service does not wait for the next round.
    add("sweeper", 0, settings);
    until([&] { return !store_->find(old); });
    EXPECT_TRUE(store_->find(young));
}

TEST_F(SharedJobs, SingleJobsOvertakeEntriesOfABatch) {
    // Some claims take entries first, but the first ones do not. The worker's first job exists before the worker, so
    // that none of these claims meets an empty queue.
    const std::string blocker = post(add("api", 0), "long");
    Process& process = add("worker", 1);
    until([&] { return process.waiting == 1; });
    add_batch("long");
    process.jobs->work_arrived();
    const std::string single = post(process, "single");
    cancel(process, blocker);
    EXPECT_EQ(ended(process, single).status, JobStatus::succeeded);
    until([&] { return process.computed().size() == 3; });
    EXPECT_THAT(process.computed(), testing::ElementsAre("long", "single", "longentry0"));
}

TEST_F(SharedJobs, ABatchGoesOnHoweverManySingleJobsWait) {
    Process& api = add("api", 0);
    std::string last;
    for (int i = 0; i < 400; i++) last = post(api, "single");
    add_batch("");
    Process& process = add("worker", 1);
    EXPECT_EQ(ended(api, last).status, JobStatus::succeeded);
    const auto computed = process.computed();
    const auto first_entry = std::find(computed.begin(), computed.end(), "entry0");
    EXPECT_NE(std::find(first_entry, computed.end(), "single"), computed.end()) << "no single job came after it";
}

}  // namespace
}  // namespace tunewright::server
