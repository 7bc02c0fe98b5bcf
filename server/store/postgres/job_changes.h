// What the writers do to single jobs inside a transaction. Changes come many at a time and cost one statement together.
#pragma once

#include <string>
#include <vector>

#include "server/store/postgres/session.h"
#include "server/store/slices.h"

namespace tunewright::server::postgres {

/// One process at a time accepts jobs of a client whose jobs are counted and unique jobs of one key, and queues a job
/// again, with its key and its batch: what others are about to commit counts. A group takes all its turns here, in one
/// order for all, before any other lock: taken one by one, two groups would wait for each other. `requeued`: ids.
void take_turns(Session& session, const std::vector<const NewJob*>& accepted, const std::vector<std::string>& requeued);

// ---- jobs, whose turns are taken: the answers stand in the order of what was asked
std::vector<Accepted> accept_jobs(Session& session, const std::vector<const NewJob*>& jobs);
std::vector<bool> finish_jobs(Session& session, const std::vector<const JobEnd*>& ends);
CancelEffect cancel_job(Session& session, const std::string& id, UnixMs now);
RequeueEffect requeue_job(Session& session, const std::string& id);
RemoveEffect remove_job(Session& session, const std::string& id);

// ---- claims, signs of life, and what becomes of the jobs of a worker that gives none: by the database's clock alone
/// The next jobs in their order, at most `claim.most`.
std::vector<JobRecord> claim_jobs(Session& session, const Claim& claim);
bool any_due(Session& session);
std::size_t start_due(Session& session);
std::vector<Holding> beat_worker(Session& session, const Heartbeat& beat);
/// Empty where it was not held; else what has become of it: queued, or cancelled. With its id.
struct Released {
    std::string id;
    JobStatus status = JobStatus::queued;
};
std::optional<Released> release_job(Session& session, std::int64_t seq, int attempts, UnixMs now);
/// Nothing where another process has done it within `what.period`.
std::optional<Recovery> reclaim_jobs(Session& session, const Reclaim& what);

// ---- notifications of ends, and the settings that all processes share
std::vector<Delivery> take_deliveries(Session& session, UnixMs now, std::chrono::milliseconds hold, std::size_t max);
bool settle_delivery(Session& session, std::int64_t seq, UnixMs now, std::optional<std::chrono::milliseconds> pause,
                     bool tried);
bool pause_queue(Session& session, bool paused);

}  // namespace tunewright::server::postgres
