// The writers' changes to single jobs inside a transaction. Many changes of a kind share one statement.
#pragma once

#include <string>
#include <vector>

#include "server/store/postgres/session.h"
#include "server/store/slices.h"

namespace tunewright::server::postgres {

/// Only one process at a time accepts jobs of a client with a limit and unique jobs of one key, and queues a job again,
/// with its key and its batch: jobs that another process is about to commit count. A group takes all these locks here,
/// in one order for all processes, before any other lock; otherwise two groups could wait for each other. `requeued`:
/// ids.
void take_turns(Session& session, const std::vector<const NewJob*>& accepted, const std::vector<std::string>& requeued);

// ---- jobs, after take_turns: the answers are in the order of the arguments
std::vector<Accepted> accept_jobs(Session& session, const std::vector<const NewJob*>& jobs);
std::vector<bool> finish_jobs(Session& session, const std::vector<const JobEnd*>& ends);
CancelEffect cancel_job(Session& session, const std::string& id, UnixMs now);
RequeueEffect requeue_job(Session& session, const std::string& id);
RemoveEffect remove_job(Session& session, const std::string& id);

// ---- claims, heartbeats, and recovery of the jobs of a worker without a lease; times are those of the database's
// clock

/// The next jobs in their order, at most `claim.most`.
std::vector<JobRecord> claim_jobs(Session& session, const Claim& claim);
bool any_due(Session& session);
std::size_t start_due(Session& session);
std::vector<Holding> beat_worker(Session& session, const Heartbeat& beat);
/// The new status: queued, or cancelled; empty if the job was not held. With its id.
struct Released {
    std::string id;
    JobStatus status = JobStatus::queued;
};
std::optional<Released> release_job(Session& session, std::int64_t seq, int attempts, UnixMs now);
/// Empty if another process has done it within `what.period`.
std::optional<Recovery> reclaim_jobs(Session& session, const Reclaim& what);

// ---- notifications, and the settings that all processes share
std::vector<Delivery> take_deliveries(Session& session, UnixMs now, std::chrono::milliseconds hold, std::size_t max);
bool settle_delivery(Session& session, std::int64_t seq, UnixMs now, std::optional<std::chrono::milliseconds> pause,
                     bool tried);
bool pause_queue(Session& session, bool paused);

}  // namespace tunewright::server::postgres
