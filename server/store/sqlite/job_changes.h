// The writer's changes to single jobs, each function inside a transaction of its own.
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "server/store/slices.h"
#include "server/store/sqlite/connection.h"

namespace tunewright::server {

// ---- the queue Upper bounds of the number of single jobs of each flow that wait or run; unknown for flows that are
// not listed.
using ClientBounds = std::unordered_map<std::string, std::size_t>;
Accepted accept_job(Connection& store, ClientBounds& bounds, const NewJob& job);
bool finish_job(Connection& store, const JobEnd& end);
CancelEffect cancel_job(Connection& store, const std::string& id, UnixMs now);
RequeueEffect requeue_job(Connection& store, const std::string& id);
RemoveEffect remove_job(Connection& store, const std::string& id);

// ---- claims, heartbeats, and recovery of the jobs of a worker without a lease
std::vector<JobRecord> claim_jobs(Connection& store, const Claim& claim);
bool any_due(Connection& store, UnixMs now);
std::size_t start_due(Connection& store, UnixMs now);
std::vector<Holding> beat_worker(Connection& store, const Heartbeat& beat);
/// `now` is the end time of a job that is cancelled instead.
bool release_job(Connection& store, std::int64_t seq, int attempts, UnixMs now);
/// Running jobs of workers without a heartbeat within a lease before `lease_at`: see JobQueue::recover().
Recovery reclaim_jobs(Connection& store, UnixMs lease_at, const Reclaim& what);

// ---- notifications, and persistent settings
bool pause_queue(Connection& store, bool paused);
bool is_paused(Connection& store);
std::vector<Delivery> take_deliveries(Connection& store, UnixMs now, std::chrono::milliseconds hold, std::size_t max);
bool settle_delivery(Connection& store, std::int64_t seq, UnixMs now, std::optional<std::chrono::milliseconds> pause,
                     bool tried);

}  // namespace tunewright::server
