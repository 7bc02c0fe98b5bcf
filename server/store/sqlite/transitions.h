// The places of a job - it waits, runs or has ended - and its ways between them, with what goes along: the counts of
// its batch, and the note to whoever wants to hear of its end. Everything that moves a job uses these.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "server/store/sqlite/connection.h"

namespace tunewright::server {

/// What a job carries while it waits or runs.
struct RowPosition {
    std::int64_t seq = 0;
    int priority = 0;
    std::int64_t turn = 0;
    std::string flow;
    std::optional<std::int64_t> batch;
    int attempts = 0;
    int crashes = 0;
};

/// A job that runs.
struct RunningJob : RowPosition {
    UnixMs started_at = 0;
    bool cancel_requested = false;
};

/// How a job ends; texts "" for none. They must live as long as the call.
struct Ending {
    JobStatus status = JobStatus::cancelled;
    UnixMs at = 0;
    bool cancel_requested = false;
    const std::string& version;
    const std::string& outline;
    const std::string& error;
    const std::string& result;

    /// Cancelled before it came to anything.
    static Ending cancelled(UnixMs at);
    static Ending failed(UnixMs at, const std::string& error);
};

/// The turn of the next job of that flow.
std::int64_t next_turn(Connection& store, int priority, const std::string& flow);

/// From the current row of a query of: seq, class, turn, flow, batch, attempts, crashes.
RowPosition read_place(const Connection::Use& row);

void put_waiting(Connection& store, const RowPosition& job, std::optional<UnixMs> not_before = std::nullopt);
/// False where it does not wait.
bool take_waiting(Connection& store, const RowPosition& job);
void put_running(Connection& store, const RowPosition& job, const std::string& worker, UnixMs now);
/// Nothing where it does not run, or not as that attempt; nullopt stands for any.
std::optional<RunningJob> take_running(Connection& store, std::int64_t seq, std::optional<int> attempts);
void put_ended(Connection& store, const RowPosition& job, std::optional<UnixMs> started_at, const Ending& ending);

/// How the counts of batches change; written once for many jobs.
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
