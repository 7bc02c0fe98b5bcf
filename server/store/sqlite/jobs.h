// Changes of single jobs and of jobs that a worker has. Each function runs inside a transaction of the writer's.
#pragma once

#include <string>
#include <vector>

#include "server/store/sqlite/connection.h"

namespace tunewright::server {

/// The state of a job that is not of a batch being deleted.
struct FoundJob {
    std::int64_t seq = 0;
    JobStatus status = JobStatus::queued;
    bool in_batch = false;
};
std::optional<FoundJob> find_job(Connection& store, const std::string& id);

Accepted accept_job(Connection& store, const NewJob& job);
bool finish_job(Connection& store, const JobEnd& end);
CancelEffect cancel_job(Connection& store, const std::string& id, UnixMs now);
RemoveEffect remove_job(Connection& store, const std::string& id);
/// Deletes at most `most` single jobs that ended before that moment; how many.
std::size_t sweep_jobs(Connection& store, UnixMs ended_before, std::size_t most);

/// The turn of the next job of that flow; single jobs are class 0, entries of batches class 1.
std::int64_t next_turn(Connection& store, int job_class, const std::string& flow);

std::vector<JobRecord> claim_jobs(Connection& store, const Claim& claim);
std::vector<Renewed> renew_jobs(Connection& store, const std::vector<Renewal>& renewals, UnixMs lease_until);
/// `now` is the end of a job that is cancelled instead.
bool release_job(Connection& store, const std::string& id, int attempts, UnixMs now);
/// Running jobs with leases that are over at `lease_at`: see JobStore::recover().
Recovery reclaim_jobs(Connection& store, UnixMs lease_at, UnixMs now, int attempts, const std::string& error);

}  // namespace tunewright::server
