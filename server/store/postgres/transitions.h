// The tables through which a job moves - waiting, running, ended - and the related changes: the counts of its batch,
// and the notification of its end.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "server/store/postgres/session.h"

namespace tunewright::server::postgres {

/// A running job, removed from its table.
struct RunningJob {
    std::int64_t seq = 0;
    std::optional<std::int64_t> batch;
    int attempts = 0;
    int crashes = 0;
    bool unwanted = false;  ///< its cancellation, or that of its batch, was requested: it ends instead of having
                            ///< another attempt
};

/// Takes a running job; empty if it does not run, or not as that attempt; 0 stands for any. put_waiting() or
/// put_ended() must follow in the same transaction, with the row's data.
class RunningRow {
public:
    static std::optional<RunningRow> take(Session& session, std::int64_t seq, int attempts);
    const RunningJob& run() const { return run_; }
    /// Queues the job again in its old position, after a pause if it has crashed; `crashes`: its number of crashes so
    /// far.
    void put_waiting(Session& session, int crashes) const;
    void put_ended(Session& session, JobStatus status, UnixMs at, const std::string& error) const;

private:
    RunningJob run_;
    std::string priority_, turn_, flow_, started_at_;
};

/// The notifications for ended jobs, which ` FROM source s` selects by their seq: a part of a statement.
std::string insert_deliveries(const std::string& source, const std::string& at);

/// Changes of batches' counts, written in one statement. Each connection counts in rows of its own, so that replicas
/// which finish entries of one batch do not wait for each other.
class BatchCounts {
public:
    void move(const std::optional<std::int64_t>& batch, std::optional<JobStatus> from, std::optional<JobStatus> to,
              std::int64_t count = 1, UnixMs ended_at = 0);
    void write(Session& session) const;

private:
    struct Change {
        std::int64_t by_status[5] = {};
        UnixMs last_end = 0;
    };
    std::map<std::int64_t, Change> changes_;
};

/// The turn after which the next job of a flow comes: the last one of its own that waits, and at least the turn that is
/// being served in its class, which is the one before the first that waits. A part of a statement.
std::string last_turn(const std::string& priority, const std::string& flow);

/// The single jobs of a flow that wait or run: a part of a statement.
std::string under_way(const std::string& flow);

/// The database's clock in milliseconds since 1970: a part of a statement.
extern const std::string kClock;

}  // namespace tunewright::server::postgres
