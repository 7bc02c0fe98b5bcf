// Waiting and running jobs. Writes are queued, made durable in groups and reported by a callback, so that no thread
// waits for a disk.
//
// A worker is a process. It sends a heartbeat (beat) for itself and not for each of its jobs; when its lease has
// expired, other processes take its jobs. `attempts` is the fencing token of a job: each claim increases it by one, and
// a worker with an older number learns that it no longer has the job. So a job ends exactly once, however slow a worker
// is that was considered dead.
//
// Turns make the queue fair. Each waiting job has one: the next number of its flow (one client, say), never below the
// turn that is being served. Jobs of normal priority come before those of low priority, which entries of batches have;
// within a class the lowest turn comes first, and of equal turns the oldest. So each flow in turn gets one job, however
// many jobs one of them has posted. Claims that prefer the low class keep it from starving.
//
// A scheduled job waits for its time in a class of its own, from which no claim takes jobs. Its turn there is that
// time; then start_due() moves it to its class, like a new job.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/clock.h"
#include "server/store/archive.h"
#include "server/store/deliveries.h"
#include "server/store/fault.h"

namespace tunewright::server {

enum class Priority { normal = 0, low = 1 };

constexpr int kScheduled = 2;  ///< the class of jobs that wait for their time

/// The origin of a job, for logs and traces.
struct JobOrigin {
    std::string request_id;   ///< of the call that posted it
    std::string traceparent;  ///< W3C trace context of that call; "" if it had none
};

struct NewJob {
    std::string id;
    std::string name;
    double timeout_s = 60;
    std::string request;
    std::string request_hash;
    std::string idempotency_key;  ///< "" if none; keys belong to an owner
    std::string owner;            ///< name of the API key; "" if no keys are required
    std::string flow;             ///< the client, for the order of turns and for `client_limit`
    UnixMs created_at = 0;
    Priority priority = Priority::normal;
    NotifyTarget notify = {};
    JobOrigin origin = {};
    std::optional<UnixMs> not_before = {};  ///< earliest start; the job is scheduled until then; empty or past: it may
                                            ///< start at once
    bool unique = false;                    ///< a job with its key that failed or was cancelled gives the key up
    std::size_t client_limit = 0;           ///< single jobs of its flow that may wait or run, including this one; 0: no
                                            ///< limit
};

/// The summary in the store's answer; `seq` and the time are the store's.
inline JobSummary summary_of(const NewJob& job) {
    JobSummary made;
    made.id = job.id;
    made.name = job.name;
    made.created_at = job.created_at;
    made.timeout_s = job.timeout_s;
    made.request_hash = job.request_hash;
    made.owner = job.owner;
    return made;
}

struct Accepted {
    /// `existing` and `conflict` only with an idempotency key; `too_many`: the flow already has `client_limit` jobs.
    enum class Kind { created, existing, conflict, too_many };
    Kind kind = Kind::created;
    JobSummary job;  ///< of created and existing
};

struct Claim {
    std::string worker;  ///< names the process
    UnixMs now = 0;
    std::chrono::milliseconds lease{10'000};  ///< as in Heartbeat
    std::size_t max = 1;
    /// Only jobs during which a process ended twice, when their pause is over; otherwise none of these.
    bool suspects = false;
    bool low_first = false;  ///< jobs of low priority before the others
};

/// The progress of a job that the caller holds, for readers elsewhere.
struct ProgressNote {
    std::int64_t seq = 0;
    std::string id;
    int attempts = 0;
    std::string progress;  ///< JSON
};

/// A heartbeat of a process.
struct Heartbeat {
    std::string worker;
    UnixMs now = 0;
    std::chrono::milliseconds lease{10'000};  ///< from now on, the time for which it keeps its jobs
    std::vector<ProgressNote> progress;
};

/// A job that a worker holds, according to the store.
struct Holding {
    std::int64_t seq = 0;
    int attempts = 0;
    bool cancel_requested = false;
    UnixMs since = 0;
};

struct JobEnd {
    std::int64_t seq = 0;
    std::string id;
    int attempts = 0;  ///< of the claim
    JobStatus status = JobStatus::failed;
    std::string result;   ///< "" if none
    std::string error;    ///< "" if none
    std::string version;  ///< of the program that computed it
    UnixMs finished_at = 0;
    std::string outline = {};  ///< as in JobSummary
    bool first = false;        ///< a client may wait for it: written before the ends of batches' entries
};

enum class CancelEffect { none, cancelled, requested, ended };  ///< none: no such job; requested: it is running
enum class RequeueEffect {
    none,
    requeued,
    not_failed,       ///< it waits, runs or has succeeded
    batch_cancelled,  ///< its whole batch was cancelled
    superseded,       ///< it was unique, and a later job has its key
    queue_full,       ///< too many jobs wait; returned by JobService, not by stores
};

/// The result of recovering jobs whose worker is gone.
struct Recovery {
    std::size_t interrupted = 0;     ///< found running without a worker: queued again
    std::size_t given_up = 0;        ///< interrupted too often, now failed
    std::vector<std::string> ended;  ///< ids of those given up, and of those cancelled instead
};

struct Reclaim {
    UnixMs now = 0;
    int max_attempts = 10;  ///< crashes
    std::string error;      ///< of a job that was interrupted this often
    bool leases = true;     ///< false: batches only. A process with the store for itself has all running jobs, however
                            ///< late its heartbeats are
    /// In a shared store one process does it: empty if another one did within that time.
    std::chrono::milliseconds period{0};
};

constexpr std::chrono::minutes kLongestPause{5};

/// The pause of a job after this number of crashes, before it can be claimed again: 1 s from the second one on, twice
/// as long each time, at most 5 min.
constexpr std::chrono::milliseconds pause_after(int crashes) {
    if (crashes < 2) return std::chrono::milliseconds(0);
    return std::min<std::chrono::milliseconds>(kLongestPause, std::chrono::seconds(1 << std::min(crashes - 2, 20)));
}

struct QueueDepth {
    std::size_t single = 0;                         ///< waiting jobs that were posted one by one
    std::size_t entries = 0;                        ///< waiting jobs of batches
    std::size_t suspects = 0;                       ///< of both: jobs that Claim::suspects would return now
    std::optional<UnixMs> next_single, next_entry;  ///< for each class, the time from which its next job waits to run
    bool paused = false;                            ///< no jobs are handed out
};

class JobQueue {
public:
    virtual ~JobQueue() = default;

    /// To be called once, before any other call: jobs whose worker is gone are queued again (cancelled if that was
    /// requested, failed with `error` from `attempts` crashes on). In a store for one process these are all running
    /// jobs; in a shared one, those whose worker's lease has expired. Batches whose upload was interrupted are dropped
    /// likewise.
    virtual Recovery recover(UnixMs now, int attempts, const std::string& error) = 0;
    /// recover() at any time and from any process. Batches whose last job has ended are settled.
    virtual void reclaim(Reclaim what, Done<Recovery> done) = 0;
    virtual QueueDepth depth() = 0;
    /// While the queue is paused, no process gets a job.
    virtual void pause(bool paused, Done<bool> done) = 0;

    /// Durable when it is reported. With a known idempotency key: the earlier job, or a conflict if its request had
    /// another hash.
    virtual void accept(NewJob job, Done<Accepted> done) = 0;
    /// The next queued jobs become running, and their attempts increase by one; fewer, or none, if not enough wait. A
    /// job whose process ended while it ran (recover(), reclaim()) counts that as a crash; a release() does not count.
    /// From the second crash on it waits: 1 s, then twice as long each time, at most 5 min.
    virtual void claim(Claim claim, Done<std::vector<JobRecord>> done) = 0;
    /// Moves scheduled jobs whose time has come to their class, a few thousand at most, and returns their number. A
    /// shared store uses its own clock only, and each job is moved by one process. Nothing is written if none is due,
    /// which is read synchronously: throws StoreError.
    virtual void start_due(UnixMs now, Done<std::size_t> done) = 0;
    /// All jobs that the store has recorded for this worker, in no order. A job that the worker holds and the store
    /// does not list is lost; a job that the store lists and the worker does not hold came in an answer that was lost:
    /// the worker releases it.
    virtual void beat(Heartbeat beat, Done<std::vector<Holding>> done) = 0;
    /// Ends a running job, durably; false if it was not running, or not with these attempts.
    virtual void finish(JobEnd end, Done<bool> done) = 0;
    /// Queues a running job again, in its old position; false as in finish().
    virtual void release(std::int64_t seq, int attempts, Done<bool> done) = 0;
    virtual void cancel(std::string id, UnixMs now, Done<CancelEffect> done) = 0;
    /// Queues a job that failed or was cancelled again, like a new one; its attempts continue to count. If its time has
    /// not come it is scheduled again. A job that has given its key up takes it back, unless a later job with the key
    /// waits, runs or has succeeded.
    virtual void requeue(std::string id, Done<RequeueEffect> done) = 0;
};

}  // namespace tunewright::server
