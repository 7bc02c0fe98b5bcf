// The tables through which a job moves - waiting, running, ended - and the related changes: the counts of its batch,
// and the notification of its end. Every change of a job's state uses these functions.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "server/store/sqlite/connection.h"

namespace tunewright::server {

/// The data of a job while it waits or runs.
struct RowPosition {
    std::int64_t seq = 0;
    int priority = 0;
    std::int64_t turn = 0;
    std::string flow;
    std::optional<std::int64_t> batch;
    int attempts = 0;
    int crashes = 0;
};

/// A running job.
struct RunningJob : RowPosition {
    UnixMs started_at = 0;
    bool cancel_requested = false;
};

/// The end of a job; texts "" for none. They must outlive the call.
struct Ending {
    JobStatus status = JobStatus::cancelled;
    UnixMs at = 0;
    bool cancel_requested = false;
    const std::string& version;
    const std::string& outline;
    const std::string& error;
    const std::string& result;

    /// Cancelled without a result.
    static Ending cancelled(UnixMs at);
    static Ending failed(UnixMs at, const std::string& error);
};

/// The turn of the flow's next job.
std::int64_t next_turn(Connection& store, int priority, const std::string& flow);

/// Reads the current row of a query of: seq, class, turn, flow, batch, attempts, crashes.
RowPosition read_place(const Connection::Use& row);

void put_waiting(Connection& store, const RowPosition& job, std::optional<UnixMs> not_before = std::nullopt);
/// False if it does not wait.
bool take_waiting(Connection& store, const RowPosition& job);
void put_running(Connection& store, const RowPosition& job, const std::string& worker, UnixMs now);
/// Empty if it does not run, or not as that attempt; nullopt stands for any.
std::optional<RunningJob> take_running(Connection& store, std::int64_t seq, std::optional<int> attempts);
void put_ended(Connection& store, const RowPosition& job, std::optional<UnixMs> started_at, const Ending& ending);

/// Changes of batches' counts; written once for many jobs.
class BatchCounts {
public:
    void move(const std::optional<std::int64_t>& batch, std::optional<JobStatus> from, std::optional<JobStatus> to,
              UnixMs ended_at = 0);
    void write(Connection& store) const;

private:
    struct Change {
        std::int64_t queued = 0, running = 0, succeeded = 0, failed = 0, cancelled = 0;
        UnixMs last_end = 0;
        std::int64_t& of(JobStatus status);
    };
    std::map<std::int64_t, Change> changes_;
};

}  // namespace tunewright::server
