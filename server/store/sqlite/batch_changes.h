// The writer's changes to batches, each function inside a transaction of its own. Changes to all entries are made in
// slices (slices.h describes each one).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/store/slices.h"
#include "server/store/sqlite/connection.h"

namespace tunewright::server {

void open_batch(Connection& store, const NewBatch& batch);
bool add_entries(Connection& store, const std::string& id, const std::vector<NewEntry>& entries, UnixMs now);
SealedBatch seal_batch(Connection& store, const BatchSeal& seal);
std::optional<std::int64_t> leave_batch(Connection& store, const std::string& id);
RemovedBatch remove_batch(Connection& store, const std::string& id);
std::size_t delete_entries(Connection& store, std::int64_t batch, std::size_t max);
std::optional<std::int64_t> begin_cancel(Connection& store, const std::string& id);
std::optional<std::int64_t> cancel_entries(Connection& store, std::int64_t batch, std::int64_t from, UnixMs now);
std::vector<std::string> end_cancel(Connection& store, std::int64_t batch);
/// Drops batches whose receiver has been silent since that moment, and settles ended ones.
Unsettled settle_batches(Connection& store, UnixMs heard_before);
std::size_t sweep_slice(Connection& store, UnixMs now, const Retention& retention, std::size_t max);

}  // namespace tunewright::server
