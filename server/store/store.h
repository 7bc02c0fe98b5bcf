// Where jobs live. One interface for every store; one suite of tests (tests/server/store/store_conformance.h) holds
// each of them to it. Reads answer at once; writes are queued, made durable in groups and reported by a callback, so
// that nobody waits for a disk.
//
// A job that a worker has is held by a lease: the store knows who has it and until when. `attempts` is the fencing
// token: it counts one more with each claim, and whoever comes with an older number learns that the job is no longer
// his. So a job ends exactly once, however slow a worker that was thought dead may be.
//
// Turns make the queue fair. Each waiting job has one: the next number of its flow (one client, say), never below the
// turn that is being served. Single jobs go before entries of batches; within a class the lowest turn goes first, the
// oldest of the same turn. So flows take turns one job each, however many jobs one of them has posted.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "server/clock.h"
#include "server/jobs/state.h"

namespace tunewright::server {

/// Why a store could not do its work.
struct StoreFault {
    enum class Kind {
        full,         ///< the disk is; nothing was changed
        unavailable,  ///< anything else of the machine's; nothing was changed
        unknown,      ///< the connection was lost during a commit: it may have been done or not
    };
    Kind kind = Kind::unavailable;
    std::string detail;  ///< for the log
};

/// Thrown by reads and when a store is opened.
class StoreError : public std::runtime_error {
public:
    explicit StoreError(const StoreFault& fault) : std::runtime_error(fault.detail), kind(fault.kind) {}
    StoreFault::Kind kind;
};

// ---- jobs ------------------------------------------------------------------------------------------------------

struct NewJob {
    std::string id;
    std::string name;
    double timeout_s = 60;
    std::string request;
    std::string request_hash;
    std::string idempotency_key;  ///< "" if none; each owner has keys of his own
    std::string owner;            ///< name of the API key; "" where none is asked for
    std::string flow;             ///< whom it counts for in the order of turns
    UnixMs created_at = 0;
};

/// Without request and result: what a list shows.
struct JobSummary {
    std::int64_t seq = 0;  ///< order of acceptance within this store
    std::string id;
    std::string name;
    JobStatus status = JobStatus::queued;
    UnixMs created_at = 0;
    std::optional<UnixMs> started_at;
    std::optional<UnixMs> finished_at;
    int attempts = 0;
    double timeout_s = 60;
    std::string request_hash;
    bool cancel_requested = false;
    std::string owner;
    std::string batch;       ///< id of the batch it belongs to; "" if none
    std::int64_t index = 0;  ///< its place in the batch, from 0
    std::string outline;     ///< JSON: what an ended job was about and what came out, in a line; "" if none
};

/// What somebody who follows a job needs.
struct JobState : JobSummary {
    std::string progress;  ///< JSON as renew() gave it; "" if none yet, or of an earlier attempt
};

struct JobRecord : JobSummary {
    std::string request;   ///< "" for an entry of a batch that could not be read
    std::string result;    ///< "" if none
    std::string error;     ///< "" if none
    std::string progress;  ///< as in JobState
};

struct JobEnd {
    std::string id;
    int attempts = 0;  ///< of the claim
    JobStatus status = JobStatus::failed;
    std::string result;   ///< "" if none
    std::string error;    ///< "" if none
    std::string version;  ///< of the program that computed it
    UnixMs finished_at = 0;
    std::string outline = {};  ///< as in JobSummary
};

struct JobQuery {
    std::optional<JobStatus> status;
    std::optional<std::string> name;
    std::optional<std::string> text;  ///< part of the name, of the id or of the outline's method, in any case
    std::optional<std::string> owner;
    std::optional<std::string> batch;  ///< only its entries; without it single jobs alone
    int limit = 50;
    std::optional<std::int64_t> before_seq;  ///< only jobs accepted before that one
};

struct JobPage {
    std::vector<JobSummary> jobs;  ///< newest first
    bool more = false;
};

struct Accepted {
    enum class Kind { created, existing, conflict };  ///< the last two only with an idempotency key
    Kind kind = Kind::created;
    JobSummary job;  ///< of created and existing
};

enum class CancelEffect { none, cancelled, requested, ended };  ///< none: no such job; requested: it is running
enum class RemoveEffect { none, removed, not_ended, in_batch };

// ---- working ---------------------------------------------------------------------------------------------------

struct Claim {
    std::string worker;  ///< names the process
    UnixMs now = 0;
    std::chrono::milliseconds lease{10'000};
    std::size_t most = 1;
    bool suspects =
        false;  ///< only jobs during which a process ended twice, when their pause is over; else none of them
};

/// A sign of life for a job that the caller has.
struct Renewal {
    std::string id;
    int attempts = 0;
    std::string progress;  ///< JSON to be kept for readers elsewhere; "" leaves what is there
};

struct Renewed {
    std::string id;
    bool held = false;  ///< false: another has it, or it has ended; whoever computes it may stop
    bool cancel_requested = false;
};

/// What became of jobs whose worker is gone.
struct Recovery {
    std::size_t interrupted = 0;     ///< found running without a worker: queued again
    std::size_t given_up = 0;        ///< interrupted too often, now failed
    std::vector<std::string> ended;  ///< ids of those given up, and of those cancelled instead
};

struct Reclaim {
    UnixMs now = 0;
    int most_attempts = 10;  ///< crashes
    std::string error;       ///< of a job that was interrupted so often
    bool leases = true;  ///< false: batches alone. Who has the store for himself has all running jobs, however late he
                         ///< renews their leases
};

// ---- batches ---------------------------------------------------------------------------------------------------

struct NewBatch {
    std::string id;
    std::string name;
    std::string owner;
    std::string flow;
    UnixMs created_at = 0;
};

struct NewEntry {
    std::int64_t index = 0;  ///< from 0 without gaps, ascending over the calls
    std::string id;
    std::string name;
    double timeout_s = 60;
    std::string request;  ///< "" where it could not be read
    std::string request_hash;
    std::string error;         ///< problem of an entry that is failed from the start; "" for one that waits
    std::string outline = {};  ///< of one that is failed from the start
};

struct BatchSummary {
    std::int64_t seq = 0;
    std::string id;
    std::string name;
    std::string owner;
    UnixMs created_at = 0;
    bool sealed = false;  ///< all its entries have come
    bool cancel_requested = false;
    std::size_t total = 0;
    std::size_t queued = 0, running = 0, succeeded = 0, failed = 0, cancelled = 0;
    std::optional<UnixMs> finished_at;  ///< of its last job, once all have ended and it is sealed

    bool ended() const { return sealed && queued == 0 && running == 0; }
};

struct BatchPage {
    std::vector<BatchSummary> batches;  ///< newest first
    bool more = false;
};

struct BatchRow {
    std::int64_t index = 0;
    std::string id;
    std::string name;
    JobStatus status = JobStatus::queued;
    std::string result;
    std::string error;
};

/// The end of a batch's way in.
struct BatchSeal {
    std::string batch;
    std::string request_hash;
    std::string idempotency_key;  ///< "" if none; each owner has keys of his own
    std::string name;             ///< where it was known only after the batch was opened; "" leaves the name
};

struct Sealed {
    enum class Kind { none, sealed, existing, conflict };  ///< existing, conflict: the batch itself has been dropped
    Kind kind = Kind::none;
    std::string id;  ///< of sealed and existing
};

// ---- the store -------------------------------------------------------------------------------------------------

template <class T>
using Outcome = std::variant<T, StoreFault>;
/// Runs on the store's own thread once the change is durable: quick, and never throws.
template <class T>
using Done = std::function<void(Outcome<T>)>;

/// What other processes on the same store have done. A hint: it may be lost, the tables are the truth.
struct StoreNotice {
    enum class Kind { queued, progress, ended, cancel };
    Kind kind = Kind::queued;
    std::string id;  ///< of the job; "" for queued, and for ended where many have (a batch was cancelled)
};

class JobStore {
public:
    virtual ~JobStore() = default;

    /// True where other processes may use the same store at the same time.
    virtual bool shared() const = 0;
    /// `listener` runs on a thread of the store's. In a store for one process it never does.
    virtual void watch(std::function<void(const StoreNotice&)> listener) = 0;
    /// False after a write failed or the connection was lost, true again after one succeeded.
    virtual bool healthy() const = 0;
    /// How far the store's own clock is ahead of this process's; 0 where it has none. All times that processes write
    /// are the store's, so that the clocks of machines need not agree.
    virtual std::chrono::milliseconds clock_ahead() const { return std::chrono::milliseconds(0); }

    /// To be called once, before any other call: jobs whose worker is gone are queued again (cancelled where that was
    /// asked for, failed with `error` from `attempts` crashes on). A store for one process takes every running job for
    /// that; a shared one those whose lease is over. Batches that were still being received are dropped likewise.
    virtual Recovery recover(UnixMs now, int attempts, const std::string& error) = 0;
    /// The same at any time and from any process, for leases that are over and batches that nobody sends any more.
    virtual void reclaim(Reclaim what, Done<Recovery> done) = 0;

    virtual std::optional<JobRecord> find(const std::string& id) = 0;
    /// Those that there are, in no order.
    virtual std::vector<JobState> states(const std::vector<std::string>& ids) = 0;
    virtual JobPage list(const JobQuery& query) = 0;
    struct Depth {
        std::size_t single = 0;                         ///< waiting jobs that were posted one by one
        std::size_t entries = 0;                        ///< waiting jobs of batches
        std::size_t suspects = 0;                       ///< of both: those that Claim::suspects would give now
        std::optional<UnixMs> next_single, next_entry;  ///< when the job of each class that is next was accepted
    };
    virtual Depth depth() = 0;

    /// Durable when it is reported. With a known idempotency key: the earlier job, or a conflict where its request
    /// had another hash.
    virtual void accept(NewJob job, Done<Accepted> done) = 0;
    /// The next queued jobs become running, their attempts count one more; fewer, or none, where not so many wait.
    /// A job whose process ended while it ran (recover(), reclaim()) counts that as a crash, which giving it back
    /// (release()) is not. From the second on it waits: 1 s, then twice as long each time, at most 5 min.
    virtual void claim(Claim claim, Done<std::vector<JobRecord>> done) = 0;
    /// Leases that the caller holds last `lease` from now. One answer for each renewal, in order.
    virtual void renew(std::vector<Renewal> renewals, UnixMs now, std::chrono::milliseconds lease,
                       Done<std::vector<Renewed>> done) = 0;
    /// A running job ends, durably; false where it was not running, or not with these attempts.
    virtual void finish(JobEnd end, Done<bool> done) = 0;
    /// A running job is queued again, at its old place; false as in finish().
    virtual void release(std::string id, int attempts, Done<bool> done) = 0;
    virtual void cancel(std::string id, UnixMs now, Done<CancelEffect> done) = 0;
    virtual void remove(std::string id, Done<RemoveEffect> done) = 0;

    /// Entries may run as soon as they are added. Until it is sealed a batch must hear from its receiver (add_entries,
    /// also with none) every `kReceiving`; then it is dropped by reclaim(), as drop_batch() does.
    static constexpr std::chrono::milliseconds kReceiving{60'000};
    virtual void open_batch(NewBatch batch, Done<bool> done) = 0;
    /// False where the batch is not there, sealed or cancelled.
    virtual void add_entries(std::string batch, std::vector<NewEntry> entries, UnixMs now, Done<bool> done) = 0;
    /// With a known key ("" if none): the earlier batch, or a conflict where its hash was another; this one is dropped.
    virtual void seal_batch(BatchSeal seal, Done<Sealed> done) = 0;
    /// The batch and its jobs are gone, whatever their state; a worker that has one learns it from renew().
    virtual void drop_batch(std::string batch, Done<bool> done) = 0;
    virtual std::optional<BatchSummary> find_batch(const std::string& id) = 0;
    virtual std::optional<std::string> batch_of_key(const std::string& owner, const std::string& idempotency_key) = 0;
    virtual BatchPage list_batches(const std::optional<std::string>& owner, int limit,
                                   std::optional<std::int64_t> before_seq) = 0;
    /// At most `limit` rows with index >= from, in order.
    virtual std::vector<BatchRow> batch_rows(const std::string& id, std::int64_t from, std::size_t limit) = 0;
    /// Waiting jobs are cancelled, running ones asked to stop: their ids. Nothing where there is no such batch.
    virtual void cancel_batch(std::string id, UnixMs now, Done<std::optional<std::vector<std::string>>> done) = 0;
    /// Only a batch whose jobs have all ended.
    virtual void remove_batch(std::string id, Done<RemoveEffect> done) = 0;

    /// Deletes at most `most` single jobs that ended longer than `age` before `now`, and batches whose last job did
    /// (one batch counts as its jobs do). A shared store goes by its own clock where that is behind `now`: a process
    /// whose clock is ahead deletes nothing too early. Returns how many jobs went; fewer than `most`: nothing is left
    /// to sweep.
    virtual void sweep(UnixMs now, std::chrono::milliseconds age, std::size_t most, Done<std::size_t> done) = 0;
};

}  // namespace tunewright::server
