// Changes of batches. What touches every entry goes in slices, each in a transaction of its own with whatever else
// waits, so that a large batch holds nobody up. How far such a change has come is in the tables: it outlives a crash.
#pragma once

#include <string>
#include <vector>

#include "server/store/batch_changes.h"
#include "server/store/sqlite/connection.h"

namespace tunewright::server {

void open_batch(Connection& store, const NewBatch& batch);
bool add_entries(Connection& store, const std::string& id, const std::vector<NewEntry>& entries, UnixMs now);
SealedBatch seal_batch(Connection& store, const BatchSeal& seal);

/// From now on it is not seen any more; delete_entries() does the rest. Its seq, or nothing where there is none.
std::optional<std::int64_t> leave_batch(Connection& store, const std::string& id);
/// One slice of a leaving batch, at the end the batch itself. How many jobs went: 0 when nothing is left.
std::size_t delete_entries(Connection& store, std::int64_t batch, std::size_t most);
RemovedBatch remove_batch(Connection& store, const std::string& id);

/// No more entries are taken; cancel_entries() does the rest. Its seq, or nothing where there is none.
std::optional<std::int64_t> begin_cancel(Connection& store, const std::string& id);
/// One slice: true where more is to be done.
bool cancel_entries(Connection& store, std::int64_t batch, UnixMs now);
/// Running entries are asked to stop: their ids. After the last slice.
std::vector<std::string> end_cancel(Connection& store, std::int64_t batch);

/// Batches whose receiver was last heard of before that moment, leaving from now on, and those already leaving.
std::vector<std::int64_t> leave_unheard(Connection& store, UnixMs heard_before);
/// Batches whose cancelling was interrupted.
std::vector<std::int64_t> being_cancelled(Connection& store);

/// One slice of JobStore::sweep(): how many jobs went, 0 when nothing is left.
std::size_t sweep_slice(Connection& store, UnixMs ended_before, std::size_t most);

}  // namespace tunewright::server
