// The writers' changes to batches inside a transaction. Changes to all entries are made in slices (slices.h describes
// each one).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "server/store/postgres/notices.h"
#include "server/store/postgres/session.h"
#include "server/store/slices.h"

namespace tunewright::server::postgres {

/// A transaction in progress, and the notices to other processes after its commit.
struct Work {
    Session& session;
    Notices& notices;
};

void open_batch(Session& session, const NewBatch& batch);
bool add_entries(Session& session, const std::string& id, const std::vector<NewEntry>& entries, UnixMs now);
SealedBatch seal_batch(Work& work, const BatchSeal& seal);
std::optional<std::int64_t> leave_batch(Work& work, const std::string& id);
RemovedBatch remove_batch(Work& work, const std::string& id);
std::size_t delete_entries(Work& work, std::int64_t batch, std::size_t max);
std::optional<std::int64_t> begin_cancel(Work& work, const std::string& id);
std::optional<std::int64_t> cancel_entries(Work& work, std::int64_t batch, std::int64_t from, UnixMs now);
std::vector<std::string> end_cancel(Work& work, std::int64_t batch);
std::size_t sweep_slice(Work& work, UnixMs now, const Retention& retention, std::size_t max);
/// Drops batches whose receiver has been silent for BatchStore::kReceiving, and settles ended ones.
Unsettled settle_batches(Session& session);

}  // namespace tunewright::server::postgres
