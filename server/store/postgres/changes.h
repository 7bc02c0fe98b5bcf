// What the writer does inside a transaction. Single jobs' changes come many at a time and cost one statement together.
#pragma once

#include <string>
#include <vector>

#include "server/store/batch_changes.h"
#include "server/store/postgres/session.h"

namespace tunewright::server::postgres {

// ---- jobs (jobs.cpp): the answers stand in the order of what was asked
std::vector<Accepted> accept_jobs(Session& session, const std::vector<const NewJob*>& jobs);
std::vector<bool> finish_jobs(Session& session, const std::vector<const JobEnd*>& ends);
CancelEffect cancel_job(Session& session, const std::string& id, UnixMs now);
RemoveEffect remove_job(Session& session, const std::string& id);

// ---- claims (claims.cpp)
/// The next jobs in their order, at most `claim.most`.
std::vector<JobRecord> claim_jobs(Session& session, const Claim& claim);
std::vector<Renewed> renew_jobs(Session& session, const std::vector<Renewal>& renewals,
                                std::chrono::milliseconds lease);
/// Empty where it was not held; else what has become of it: queued, or cancelled.
std::optional<JobStatus> release_job(Session& session, const std::string& id, int attempts, UnixMs now);
Recovery reclaim_jobs(Session& session, UnixMs now, int attempts, const std::string& error);

// ---- batches (batches.cpp): what touches every entry goes in slices of kSlice entries, each in a transaction with
// whatever else waits
void open_batch(Session& session, const NewBatch& batch);
bool add_entries(Session& session, const std::string& id, const std::vector<NewEntry>& entries, UnixMs now);
SealedBatch seal_batch(Session& session, const BatchSeal& seal);
/// From now on it is not seen any more; delete_entries() does the rest. Its seq, or nothing where there is none.
std::optional<std::int64_t> leave_batch(Session& session, const std::string& id);
/// One slice of a leaving batch, at the end the batch itself. How many jobs went: 0 when nothing is left.
std::size_t delete_entries(Session& session, std::int64_t batch, std::size_t most);
RemovedBatch remove_batch(Session& session, const std::string& id);
/// No more entries are taken; cancel_entries() does the rest. Its seq, or nothing where there is none.
std::optional<std::int64_t> begin_cancel(Session& session, const std::string& id);
/// One slice, from that index on: where the next begins, or nothing after the last.
std::optional<std::int64_t> cancel_entries(Session& session, std::int64_t batch, std::int64_t from, UnixMs now);
/// Running entries are asked to stop: their ids. After the last slice.
std::vector<std::string> end_cancel(Session& session, std::int64_t batch);
/// What an earlier process left undone.
struct Unsettled {
    std::vector<std::int64_t> leaving;     ///< with those whose receiver has not been heard of for JobStore::kReceiving
    std::vector<std::int64_t> cancelling;  ///< cancelled, and entries still wait
};
Unsettled find_unsettled(Session& session);
struct Retention {
    UnixMs now = 0;  ///< of this process; the database's clock counts where it is behind
    std::chrono::milliseconds age{};
};
/// One slice of JobStore::sweep(): how many jobs went, 0 when nothing is left.
std::size_t sweep_slice(Session& session, const Retention& retention, std::size_t most);

}  // namespace tunewright::server::postgres
