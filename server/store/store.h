// Where jobs live. One interface for every store; one suite of tests (tests/server/store_conformance.h) holds each of
// them to it. Reads answer at once; writes are queued, made durable in groups and reported by a callback, so that
// nobody waits for a disk.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

#include "server/jobs/state.h"

namespace tunewright::server {

using UnixMs = std::int64_t;  ///< milliseconds since 1970, UTC

/// Why a store could not do its work: the disk is full, or anything else of the machine's.
struct StoreFault {
    enum class Kind { full, unavailable };
    Kind kind = Kind::unavailable;
    std::string detail;  ///< for the log
};

/// Thrown by reads and when a store is opened.
class StoreError : public std::runtime_error {
public:
    explicit StoreError(const StoreFault& fault) : std::runtime_error(fault.detail), kind(fault.kind) {}
    StoreFault::Kind kind;
};

struct NewJob {
    std::string id;
    std::string name;
    double timeout_s = 60;
    std::string request;
    std::string request_hash;
    std::string idempotency_key;  ///< "" if none
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
};

struct JobRecord : JobSummary {
    std::string request;
    std::string result;  ///< "" if none
    std::string error;   ///< "" if none
};

struct JobEnd {
    std::string id;
    JobStatus status = JobStatus::failed;
    std::string result;   ///< "" if none
    std::string error;    ///< "" if none
    std::string version;  ///< of the program that computed it
    UnixMs finished_at = 0;
};

struct JobQuery {
    std::optional<JobStatus> status;
    std::optional<std::string> name;
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
enum class RemoveEffect { none, removed, not_ended };

struct Recovery {
    std::size_t queued = 0;       ///< waiting jobs, with those that were interrupted
    std::size_t interrupted = 0;  ///< found running: queued again
    std::size_t given_up = 0;     ///< interrupted too often, now failed
};

template <class T>
using Outcome = std::variant<T, StoreFault>;
/// Runs on the store's own thread once the change is durable: quick, and never throws.
template <class T>
using Done = std::function<void(Outcome<T>)>;

class JobStore {
public:
    virtual ~JobStore() = default;

    /// To be called once, before anything else: running jobs are queued again (cancelled where that was asked for,
    /// failed with `error` from `attempts` on).
    virtual Recovery recover(UnixMs now, int attempts, const std::string& error) = 0;

    virtual std::optional<JobRecord> find(const std::string& id) = 0;
    virtual JobPage list(const JobQuery& query) = 0;

    /// Durable when it is reported. With a known idempotency key: the earlier job, or a conflict where its request
    /// had another hash.
    virtual void accept(NewJob job, Done<Accepted> done) = 0;
    /// The oldest queued job becomes running, its attempts count one more; nothing where none is queued.
    virtual void claim_next(UnixMs now, Done<std::optional<JobRecord>> done) = 0;
    /// A running job ends, durably; false where it was not running.
    virtual void finish(JobEnd end, Done<bool> done) = 0;
    /// A running job is queued again; false where it was not running.
    virtual void release(std::string id, Done<bool> done) = 0;
    virtual void cancel(std::string id, UnixMs now, Done<CancelEffect> done) = 0;
    virtual void remove(std::string id, Done<RemoveEffect> done) = 0;

    /// False after a write failed, true again after one succeeded.
    virtual bool healthy() const = 0;
};

}  // namespace tunewright::server
