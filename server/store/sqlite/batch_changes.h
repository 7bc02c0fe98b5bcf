// What the writer does to batches, each function inside a transaction of its own. What touches every entry goes in
// slices (slices.h says what each does).
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
/// Batches whose receiver was last heard of before that moment are dropped; ended ones are settled.
Unsettled settle_batches(Connection& store, UnixMs heard_before);
std::size_t sweep_slice(Connection& store, UnixMs now, const Retention& retention, std::size_t max);

}  // namespace tunewright::server
