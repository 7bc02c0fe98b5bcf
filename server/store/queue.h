// Jobs that wait and jobs that run. Writes are queued, made durable in groups and reported by a callback, so that
// nobody waits for a disk.
//
// A worker is a process. It gives a sign of life (beat) for itself and not for each of its jobs; when the time that it
// gave itself is over, others take its jobs. `attempts` is the fencing token of a job: it counts one more with each
// claim, and whoever comes with an older number learns that the job is no longer his. So a job ends exactly once,
// however slow a worker that was thought dead may be.
//
// Turns make the queue fair. Each waiting job has one: the next number of its flow (one client, say), never below the
// turn that is being served. Jobs of normal priority go before those of low priority, which entries of batches have;
// within a class the lowest turn goes first, the oldest of the same turn. So flows take turns one job each, however
// many jobs one of them has posted. A claim that asks for the low class first is how that class never starves.
//
// A scheduled job waits for its time in a class of its own, which no claim looks at. Its turn there is that time; then
// start_due() moves it to its class, as if it had just come.
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

/// Where a job came from, for logs and traces.
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
    std::string idempotency_key;  ///< "" if none; each owner has keys of his own
    std::string owner;            ///< name of the API key; "" where none is asked for
    std::string flow;             ///< whom it counts for in the order of turns, and for `client_limit`
    UnixMs created_at = 0;
    Priority priority = Priority::normal;
    NotifyTarget notify = {};
    JobOrigin origin = {};
    std::optional<UnixMs> not_before = {};  ///< its time; it is scheduled until then, or has none where that is over
    bool unique = false;                    ///< a job of its key that failed or was cancelled gives the key up
    std::size_t client_limit = 0;           ///< single jobs of its flow that may wait or run, this one included; 0: any
};

/// As the store answers it; `seq` and the time are the store's.
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
    /// `existing` and `conflict` only with an idempotency key; `too_many`: the flow has `client_limit` jobs already.
    enum class Kind { created, existing, conflict, too_many };
    Kind kind = Kind::created;
    JobSummary job;  ///< of created and existing
};

struct Claim {
    std::string worker;  ///< names the process
    UnixMs now = 0;
    std::chrono::milliseconds lease{10'000};  ///< a sign of life, as Heartbeat has it
    std::size_t max = 1;
    /// Only jobs during which a process ended twice, when their pause is over; else none of them.
    bool suspects = false;
    bool low_first = false;  ///< jobs of low priority before the others
};

/// What a job that the caller has shows to readers elsewhere.
struct ProgressNote {
    std::int64_t seq = 0;
    std::string id;
    int attempts = 0;
    std::string progress;  ///< JSON
};

/// A sign of life of a process.
struct Heartbeat {
    std::string worker;
    UnixMs now = 0;
    std::chrono::milliseconds lease{10'000};  ///< its jobs are its own until so long after now
    std::vector<ProgressNote> progress;
};

/// A job that a worker has, as the store knows it.
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
    bool first = false;        ///< somebody may wait for it: before ends of batches' entries
};

enum class CancelEffect { none, cancelled, requested, ended };  ///< none: no such job; requested: it is running
enum class RequeueEffect {
    none,
    requeued,
    not_failed,       ///< it waits, runs or has succeeded
    batch_cancelled,  ///< its batch as a whole was cancelled
    superseded,       ///< it was unique, and a later job has its key
    queue_full,       ///< no more may wait; no store says so
};

/// What became of jobs whose worker is gone.
struct Recovery {
    std::size_t interrupted = 0;     ///< found running without a worker: queued again
    std::size_t given_up = 0;        ///< interrupted too often, now failed
    std::vector<std::string> ended;  ///< ids of those given up, and of those cancelled instead
};

struct Reclaim {
    UnixMs now = 0;
    int max_attempts = 10;  ///< crashes
    std::string error;      ///< of a job that was interrupted so often
    bool leases = true;     ///< false: batches alone. Who has the store for himself has all running jobs, however late
                            ///< his signs of life are
    /// In a shared store one process does it: nothing where another did within that time.
    std::chrono::milliseconds period{0};
};

constexpr std::chrono::minutes kLongestPause{5};

/// What a job waits, after it was interrupted so often, before it is handed out again: 1 s from the second time on,
/// twice as long each time, at most 5 min.
constexpr std::chrono::milliseconds pause_after(int crashes) {
    if (crashes < 2) return std::chrono::milliseconds(0);
    return std::min<std::chrono::milliseconds>(kLongestPause, std::chrono::seconds(1 << std::min(crashes - 2, 20)));
}

struct QueueDepth {
    std::size_t single = 0;                         ///< waiting jobs that were posted one by one
    std::size_t entries = 0;                        ///< waiting jobs of batches
    std::size_t suspects = 0;                       ///< of both: those that Claim::suspects would give now
    std::optional<UnixMs> next_single, next_entry;  ///< since when the job of each class that is next waits to run
    bool paused = false;                            ///< nothing is handed out
};

class JobQueue {
public:
    virtual ~JobQueue() = default;

    /// To be called once, before any other call: jobs whose worker is gone are queued again (cancelled where that was
    /// asked for, failed with `error` from `attempts` crashes on). A store for one process takes every running job for
    /// that; a shared one those whose worker gives no sign of life. Batches that were still being received are dropped
    /// likewise.
    virtual Recovery recover(UnixMs now, int attempts, const std::string& error) = 0;
    /// The same at any time and from any process. Batches whose last job has ended are settled.
    virtual void reclaim(Reclaim what, Done<Recovery> done) = 0;
    virtual QueueDepth depth() = 0;
    /// While it is paused no job is handed out, to any process.
    virtual void pause(bool paused, Done<bool> done) = 0;

    /// Durable when it is reported. With a known idempotency key: the earlier job, or a conflict where its request
    /// had another hash.
    virtual void accept(NewJob job, Done<Accepted> done) = 0;
    /// The next queued jobs become running, their attempts count one more; fewer, or none, where not so many wait.
    /// A job whose process ended while it ran (recover(), reclaim()) counts that as a crash, which giving it back
    /// (release()) is not. From the second on it waits: 1 s, then twice as long each time, at most 5 min.
    virtual void claim(Claim claim, Done<std::vector<JobRecord>> done) = 0;
    /// Scheduled jobs whose time has come wait for their turns, some thousand at most: how many. A shared store goes by
    /// its own clock alone, and each job is moved by one process. Nothing is written where none is due, which is read
    /// at once: throws StoreError.
    virtual void start_due(UnixMs now, Done<std::size_t> done) = 0;
    /// All jobs that the store takes for this worker's, in no order. What the worker holds and the store does not name
    /// is lost; what the store names and the worker does not hold came in an answer that was lost: it releases it.
    virtual void beat(Heartbeat beat, Done<std::vector<Holding>> done) = 0;
    /// A running job ends, durably; false where it was not running, or not with these attempts.
    virtual void finish(JobEnd end, Done<bool> done) = 0;
    /// A running job is queued again, at its old place; false as in finish().
    virtual void release(std::int64_t seq, int attempts, Done<bool> done) = 0;
    virtual void cancel(std::string id, UnixMs now, Done<CancelEffect> done) = 0;
    /// A job that failed or was cancelled waits again, as if it had just come; its attempts go on counting. If its time
    /// has not come it is scheduled again. One that has given its key up takes it back; not while a later one that has
    /// the key waits, runs or has succeeded.
    virtual void requeue(std::string id, Done<RequeueEffect> done) = 0;
};

}  // namespace tunewright::server
