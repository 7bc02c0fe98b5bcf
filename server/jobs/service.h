// The queue and its workers: accepts tuning requests, computes them, stores the results.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "api/service.h"
#include "engine/progress.h"
#include "server/jobs/followers.h"
#include "server/jobs/queue_bound.h"
#include "server/jobs/running/claims.h"
#include "server/jobs/running/heartbeats.h"
#include "server/jobs/running/held.h"
#include "server/jobs/running/rescuer.h"
#include "server/jobs/running/result_outbox.h"
#include "server/jobs/running/workers.h"
#include "server/jobs/store_outage_log.h"
#include "server/jobs/sweeper.h"
#include "server/jobs/waits.h"
#include "server/store/store.h"
#include "server/threads/periodic_thread.h"
#include "server/threads/timer.h"

namespace tunewright::server {

/// Events, for metrics; the callbacks run on the threads of workers and of the store.
struct JobObserver {
    std::function<void(const Ended& ended)> ended;  ///< once for each job that a worker ended, when it is stored
    std::function<void()> dropped;  ///< a result came too late: another process has the job, or has ended it
    std::function<void(const JobRecord& job)> begun;       ///< a worker begins with it
    std::function<void()> limited;                         ///< a client has the maximum number of jobs waiting or
                                                           ///< running
    std::function<void(const Recovery& found)> recovered;  ///< jobs whose process had ended, at the start and later
};

struct JobSettings {
    std::string name;                     ///< of this process, for leases; "": a random one
    std::size_t workers = 1;              ///< 0: this process accepts requests and computes nothing
    std::size_t queue_limit = 10'000;     ///< single jobs that may wait, all processes together
    std::size_t entry_limit = 1'000'000;  ///< entries of batches that may wait
    std::size_t client_jobs = 0;          ///< single jobs of one client that may wait or run; 0: any number
    int max_attempts = 10;                ///< a job that was interrupted this often fails
    std::chrono::milliseconds lease{10'000};
    /// The interval at which the store is checked for changes by other processes, in addition to notices.
    std::chrono::milliseconds poll{500};
    Retention retention;  ///< how long ended jobs are kept
    std::string version;
    /// Computes a job: api::run_job, or a function of a test.
    std::function<api::JobOutcome(const api::StoredRequest& request, const RunControl& control)> run;
    std::function<UnixMs()> now;  ///< wall clock
    JobObserver observer;
};

struct Submission {
    enum class Kind { created, existing, conflict, queue_full, too_many, draining, store_failed };
    Kind kind = Kind::store_failed;
    JobRecord job;     ///< of created and existing (the latter without request and result)
    StoreFault fault;  ///< of store_failed
};

/// The notification target of a job or a batch, in the store's form.
inline NotifyTarget target_of(const std::optional<api::Notify>& notify) {
    return notify ? NotifyTarget{notify->url, notify->secret_id} : NotifyTarget{};
}

/// A request that is to become a job.
struct Order {
    api::PreparedJob job;
    std::string idempotency_key;
    std::string owner;  ///< as in NewJob
    std::string flow;
    JobOrigin origin;
    std::chrono::duration<double> wait{0};
};

class JobService {
public:
    /// Both references must outlive it; before its destruction the timer must have stopped, and the store must be
    /// destroyed or have answered each call.
    JobService(JobStore& store, Timer& timer, JobSettings settings);
    /// Stops like drain(), without grace.
    ~JobService();
    JobService(const JobService&) = delete;
    JobService& operator=(const JobService&) = delete;

    /// Recovers the jobs that an earlier process left, and starts the workers.
    Recovery start();

    /// `done` runs once, when the job is durable or refused. If `wait` > 0 and the job is created, `ended` runs once
    /// after it: when the job has ended (in any process; with the job if it was this one), or when `wait` is over.
    void submit(Order order, std::function<void(Submission)> done, WaitEnd ended);

    /// Reads throw StoreError.
    std::optional<JobView> find(const std::string& id);
    /// The state without request and result.
    std::optional<JobState> state(const std::string& id);
    JobPage list(const JobQuery& query) { return store_.list(query); }
    /// A running job is asked to stop; it ends soon after, not necessarily before `done`.
    void cancel(const std::string& id, Done<CancelEffect> done);
    void remove(const std::string& id, Done<RemoveEffect> done) { store_.remove(id, std::move(done)); }
    /// Queues the job like a new one, if there is room. Throws StoreError.
    void requeue(const std::string& id, Done<RequeueEffect> done);
    /// While the queue is paused no process on this store begins a job; running ones continue.
    void pause(bool paused, Done<bool> done);

    /// Calls `ended` once: as soon as the job has ended (also if it already had), at the latest after `wait`.
    void wait(const std::string& id, std::chrono::duration<double> wait, WaitEnd ended);

    /// Like Followers::follow(); a job that does not exist is `gone`.
    Followers::Key follow(const std::string& id, Followers::Listener listener) {
        return followers_.follow(id, std::move(listener));
    }
    void unfollow(Followers::Key key) { followers_.leave(key); }

    // ---- for batches (batches.h), which store their entries themselves True if this number of further entries may
    // wait; they are counted as waiting from now on.
    bool room_for_entries(std::size_t count);
    /// Entries have been queued: workers check, here and (after the store's notice) elsewhere.
    void work_arrived();
    /// Running jobs of these ids that run here are stopped as cancelled.
    void stop_running(const std::vector<std::string>& ids);
    /// An incomplete batch is dropped: its entries that run here stop, and their results are not needed.
    void batch_dropped(const std::string& batch);
    /// Jobs have ended without a worker (a batch was cancelled): waits for them check again.
    void look_again();

    /// Accepts no more work; running jobs get `grace` to end, then they are stopped and queued again. Waiting clients
    /// get the job in its current state. Returns true if every worker has stopped within two more seconds.
    bool drain(std::chrono::duration<double> grace);

    /// Seconds after which a full queue has room again, from the pace of the latest jobs: 1 to 60.
    int seconds_until_room() const;

    std::size_t client_jobs() const { return settings_.client_jobs; }
    bool draining() const { return draining_; }
    /// Jobs accepted and not yet running, including those being accepted.
    std::size_t queued() const { return depth_.now().single + depth_.now().entries; }
    QueueDepth depth() const { return depth_.now(); }
    /// Number of jobs that this process holds.
    std::size_t running() const { return held_.size(); }
    std::size_t workers() const { return settings_.workers; }
    /// Number of followers of jobs in this process.
    std::size_t followers() const { return followers_.count(); }

private:
    ClaimSettings claim_settings();
    ResultOutbox::Listener end_listener();
    HeartbeatSettings heartbeat_settings();
    RescuerSettings rescuer_settings();
    WorkerSettings worker_settings();

    void ended(const Ended& ended, bool kept);
    void stop_held(const std::shared_ptr<HeldJob>& held, HeldJob::Stop why);
    void forget(const std::shared_ptr<HeldJob>& held);
    void give_back_unbegun();
    Submission submission_of_key(const Order& order);
    void tell_ended(const std::string& id);
    void hear(const StoreNotice& notice);
    std::chrono::milliseconds tend();
    std::chrono::milliseconds look();

    JobStore& store_;
    JobSettings settings_;
    std::atomic<bool> draining_ = false;
    std::optional<bool> drained_;  ///< return value of drain()
    StoreOutageLog outage_;
    QueueBound depth_;
    HeldJobs held_;
    Waits waits_;
    Followers followers_;
    Claims claims_;
    ResultOutbox outbox_;
    Heartbeats heartbeats_;
    Rescuer rescuer_;
    Workers workers_;
    std::atomic<bool> look_again_ = false;
    Sweeper sweeper_;
    HeldJob::Clock::time_point next_beat_{};  ///< this and the next member are used by the tending thread
    HeldJob::Clock::time_point next_upkeep_{};
    HeldJob::Clock::time_point next_depth_{};  ///< used by the looking thread
    std::unique_ptr<PeriodicThread> tending_;  ///< beats, rescues, retries: only queues writes, so it never blocks
    std::unique_ptr<PeriodicThread> looking_;  ///< reads the store, which may take long
};

}  // namespace tunewright::server
