// What the writers do inside a transaction. Single jobs' changes come many at a time and cost one statement together;
// what touches every entry of a batch goes in slices (slices.h says what each does).
#pragma once

#include <string>
#include <vector>

#include "server/store/postgres/notices.h"
#include "server/store/postgres/session.h"
#include "server/store/slices.h"

namespace tunewright::server::postgres {

/// A transaction under way, and what other processes are told when it is committed.
struct Work {
    Session& session;
    Notices& notices;
};

// ---- jobs (jobs.cpp): the answers stand in the order of what was asked
std::vector<Accepted> accept_jobs(Session& session, const std::vector<const NewJob*>& jobs);
std::vector<bool> finish_jobs(Session& session, const std::vector<const JobEnd*>& ends);
CancelEffect cancel_job(Session& session, const std::string& id, UnixMs now);
RequeueEffect requeue_job(Session& session, const std::string& id);
RemoveEffect remove_job(Session& session, const std::string& id);

// ---- claims (claims.cpp)
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

// ---- batches (batches.cpp)
void open_batch(Session& session, const NewBatch& batch);
bool add_entries(Session& session, const std::string& id, const std::vector<NewEntry>& entries, UnixMs now);
SealedBatch seal_batch(Work& work, const BatchSeal& seal);
std::optional<std::int64_t> leave_batch(Work& work, const std::string& id);
RemovedBatch remove_batch(Work& work, const std::string& id);
std::size_t delete_entries(Work& work, std::int64_t batch, std::size_t most);
std::optional<std::int64_t> begin_cancel(Work& work, const std::string& id);
std::optional<std::int64_t> cancel_entries(Work& work, std::int64_t batch, std::int64_t from, UnixMs now);
std::vector<std::string> end_cancel(Work& work, std::int64_t batch);
std::size_t sweep_slice(Work& work, UnixMs now, const Retention& retention, std::size_t most);
/// Batches whose receiver has not been heard of for BatchStore::kReceiving are dropped; ended ones are settled.
Unsettled settle_batches(Session& session);

// ---- deliveries and settings (deliveries.cpp)
std::vector<Delivery> take_deliveries(Session& session, UnixMs now, std::chrono::milliseconds hold, std::size_t most);
bool settle_delivery(Session& session, std::int64_t seq, UnixMs now, std::optional<std::chrono::milliseconds> pause,
                     bool tried);
bool pause_queue(Session& session, bool paused);

}  // namespace tunewright::server::postgres
