// Look-up, lists and deletion of jobs in any state. Reads are synchronous.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/clock.h"
#include "server/store/fault.h"
#include "server/store/job_state.h"

namespace tunewright::server {

/// A job without request and result, for lists.
struct JobSummary {
    std::int64_t seq = 0;  ///< order of acceptance within this store
    std::string id;
    std::string name;
    JobStatus status = JobStatus::queued;
    UnixMs created_at = 0;
    std::optional<UnixMs> started_at;  ///< of the current or last attempt
    std::optional<UnixMs> finished_at;
    int attempts = 0;
    double timeout_s = 60;
    std::string request_hash;
    bool cancel_requested = false;
    std::string owner;
    std::string batch;                 ///< id of the batch it belongs to; "" if none
    std::int64_t index = 0;            ///< its index in the batch, from 0
    std::string outline;               ///< JSON: a summary of an ended job and its result; "" if none
    std::string request_id;            ///< of the call that posted it; "" if unknown
    std::string traceparent;           ///< of that call; "" if it had none
    std::optional<UnixMs> not_before;  ///< earliest start; empty for a job that may start at once
    bool settled = false;  ///< cannot be queued again: its request could not be read, or its batch was cancelled
};

/// The time from which a job could run if nothing else delayed it.
inline UnixMs ready_at(const JobSummary& job) { return std::max(job.created_at, job.not_before.value_or(0)); }

/// The state for a client that follows a job.
struct JobState : JobSummary {
    std::string progress;  ///< JSON as given to beat(); "" if none yet, or of an earlier attempt
};

struct JobRecord : JobSummary {
    std::string request;    ///< "" for an entry of a batch that could not be read
    std::string result;     ///< "" if none
    std::string error;      ///< "" if none
    std::string progress;   ///< as in JobState
    bool notifies = false;  ///< its end is delivered to a target of its own; known for a job from claim()
};

struct JobQuery {
    std::optional<JobStatus> status;
    std::optional<std::string> name;
    std::optional<std::string> text;  ///< part of the name, of the id or of the outline's method, in any letter case
    std::optional<std::string> owner;
    std::optional<std::string> batch;  ///< only its entries; if empty, only single jobs
    int limit = 50;
    std::optional<std::int64_t> before_seq;  ///< only jobs accepted before that one
};

struct JobPage {
    std::vector<JobSummary> jobs;  ///< newest first
    bool more = false;
};

enum class RemoveEffect { none, removed, not_ended, in_batch };

/// Retention of ended jobs, by their state; empty: forever.
struct Retention {
    using Age = std::optional<std::chrono::milliseconds>;
    Age succeeded, failed, cancelled;

    std::array<std::pair<JobStatus, Age>, 3> by_state() const {
        return {{{JobStatus::succeeded, succeeded}, {JobStatus::failed, failed}, {JobStatus::cancelled, cancelled}}};
    }
    /// Retention of batches, whose jobs ended in any state: the longest.
    Age longest() const {
        if (!succeeded || !failed || !cancelled) return std::nullopt;
        return std::max({*succeeded, *failed, *cancelled});
    }
};

class JobArchive {
public:
    virtual ~JobArchive() = default;

    virtual std::optional<JobRecord> find(const std::string& id) = 0;
    /// The states of the existing ones of these jobs, in no order.
    virtual std::vector<JobState> states(const std::vector<std::string>& ids) = 0;
    /// The job that was accepted with this key of the owner, while it is stored.
    virtual std::optional<JobState> job_of_key(const std::string& owner, const std::string& idempotency_key) = 0;
    virtual JobPage list(const JobQuery& query) = 0;
    virtual void remove(std::string id, Done<RemoveEffect> done) = 0;
    /// Deletes at most `max` single jobs that ended longer before `now` than `retention` says, and batches whose last
    /// job did (one batch counts as its jobs do). A shared store uses its own clock if that is behind `now`, so that a
    /// process whose clock is ahead deletes nothing too early; and one process sweeps at a time. Returns the number of
    /// deleted jobs; fewer than `max`: nothing is left to sweep.
    virtual void sweep(UnixMs now, Retention retention, std::size_t max, Done<std::size_t> done) = 0;
};

}  // namespace tunewright::server
