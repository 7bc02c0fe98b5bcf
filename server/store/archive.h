// Jobs as they are looked up and listed, whatever their state, and how those that have ended go. Reads answer at once.
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

/// Without request and result: what a list shows.
struct JobSummary {
    std::int64_t seq = 0;  ///< order of acceptance within this store
    std::string id;
    std::string name;
    JobStatus status = JobStatus::queued;
    UnixMs created_at = 0;
    std::optional<UnixMs> started_at;  ///< of the attempt that runs or ran last
    std::optional<UnixMs> finished_at;
    int attempts = 0;
    double timeout_s = 60;
    std::string request_hash;
    bool cancel_requested = false;
    std::string owner;
    std::string batch;                 ///< id of the batch it belongs to; "" if none
    std::int64_t index = 0;            ///< its place in the batch, from 0
    std::string outline;               ///< JSON: what an ended job was about and what came out, in a line; "" if none
    std::string request_id;            ///< of the call that posted it; "" if unknown
    std::string traceparent;           ///< of that call; "" if it had none
    std::optional<UnixMs> not_before;  ///< it is not begun before; nothing for a job that could begin at once
    bool settled = false;  ///< cannot be queued again: its request could not be read, or its batch was cancelled
};

/// Since when a job waits to be run, if nothing else held it up.
inline UnixMs ready_at(const JobSummary& job) { return std::max(job.created_at, job.not_before.value_or(0)); }

/// What somebody who follows a job needs.
struct JobState : JobSummary {
    std::string progress;  ///< JSON as beat() gave it; "" if none yet, or of an earlier attempt
};

struct JobRecord : JobSummary {
    std::string request;    ///< "" for an entry of a batch that could not be read
    std::string result;     ///< "" if none
    std::string error;      ///< "" if none
    std::string progress;   ///< as in JobState
    bool notifies = false;  ///< its end is delivered to a target of its own; known of a job that claim() gave
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

enum class RemoveEffect { none, removed, not_ended, in_batch };

/// How long ended jobs are kept, by their state; nothing: for ever.
struct Retention {
    using Age = std::optional<std::chrono::milliseconds>;
    Age succeeded, failed, cancelled;

    std::array<std::pair<JobStatus, Age>, 3> by_state() const {
        return {{{JobStatus::succeeded, succeeded}, {JobStatus::failed, failed}, {JobStatus::cancelled, cancelled}}};
    }
    /// What batches are kept for, whose jobs ended in any state: the longest.
    Age longest() const {
        if (!succeeded || !failed || !cancelled) return std::nullopt;
        return std::max({*succeeded, *failed, *cancelled});
    }
};

class JobArchive {
public:
    virtual ~JobArchive() = default;

    virtual std::optional<JobRecord> find(const std::string& id) = 0;
    /// Those that there are, in no order.
    virtual std::vector<JobState> states(const std::vector<std::string>& ids) = 0;
    /// The job that was accepted under this key of an owner's, as long as it is kept.
    virtual std::optional<JobState> job_of_key(const std::string& owner, const std::string& idempotency_key) = 0;
    virtual JobPage list(const JobQuery& query) = 0;
    virtual void remove(std::string id, Done<RemoveEffect> done) = 0;
    /// Deletes at most `max` single jobs that ended longer before `now` than `retention` says, and batches whose last
    /// job did (one batch counts as its jobs do). A shared store goes by its own clock where that is behind `now`: a
    /// process whose clock is ahead deletes nothing too early; and one process sweeps at a time. Returns how many jobs
    /// went; fewer than `max`: nothing is left to sweep.
    virtual void sweep(UnixMs now, Retention retention, std::size_t max, Done<std::size_t> done) = 0;
};

}  // namespace tunewright::server
