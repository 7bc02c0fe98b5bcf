// What the writer does. Each function runs inside a transaction of its own; what touches every entry of a batch goes in
// slices (slices.h says what each does).
#pragma once

#include <string>
#include <unordered_map>
#include <vector>

#include "server/store/slices.h"
#include "server/store/sqlite/connection.h"

namespace tunewright::server {

// ---- queue.cpp
/// At most so many single jobs of each flow wait or run; of flows that are not in it nothing is known.
using ClientBounds = std::unordered_map<std::string, std::size_t>;
Accepted accept_job(Connection& store, ClientBounds& bounds, const NewJob& job);
bool finish_job(Connection& store, const JobEnd& end);
CancelEffect cancel_job(Connection& store, const std::string& id, UnixMs now);
RequeueEffect requeue_job(Connection& store, const std::string& id);
RemoveEffect remove_job(Connection& store, const std::string& id);

// ---- claims.cpp
std::vector<JobRecord> claim_jobs(Connection& store, const Claim& claim);
bool any_due(Connection& store, UnixMs now);
std::size_t start_due(Connection& store, UnixMs now);
std::vector<Holding> beat_worker(Connection& store, const Heartbeat& beat);
/// `now` is the end of a job that is cancelled instead.
bool release_job(Connection& store, std::int64_t seq, int attempts, UnixMs now);
/// Running jobs whose worker has given no sign of life for a lease at `lease_at`: see JobQueue::recover().
Recovery reclaim_jobs(Connection& store, UnixMs lease_at, const Reclaim& what);

// ---- batches.cpp
void open_batch(Connection& store, const NewBatch& batch);
bool add_entries(Connection& store, const std::string& id, const std::vector<NewEntry>& entries, UnixMs now);
SealedBatch seal_batch(Connection& store, const BatchSeal& seal);
std::optional<std::int64_t> leave_batch(Connection& store, const std::string& id);
RemovedBatch remove_batch(Connection& store, const std::string& id);
std::size_t delete_entries(Connection& store, std::int64_t batch, std::size_t most);
std::optional<std::int64_t> begin_cancel(Connection& store, const std::string& id);
std::optional<std::int64_t> cancel_entries(Connection& store, std::int64_t batch, std::int64_t from, UnixMs now);
std::vector<std::string> end_cancel(Connection& store, std::int64_t batch);
/// Batches whose receiver was last heard of before that moment are dropped; ended ones are settled.
Unsettled settle_batches(Connection& store, UnixMs heard_before);
std::size_t sweep_slice(Connection& store, UnixMs now, const Retention& retention, std::size_t most);

// ---- deliveries and settings (deliveries.cpp)
bool pause_queue(Connection& store, bool paused);
bool is_paused(Connection& store);
std::vector<Delivery> take_deliveries(Connection& store, UnixMs now, std::chrono::milliseconds hold, std::size_t most);
bool settle_delivery(Connection& store, std::int64_t seq, UnixMs now, std::optional<std::chrono::milliseconds> pause,
                     bool tried);

}  // namespace tunewright::server
