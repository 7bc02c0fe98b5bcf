// Reads. Each function runs on a connection of its own that only reads.
#pragma once

#include <string>
#include <vector>

#include "server/store/sqlite/connection.h"

namespace tunewright::server {

std::optional<JobRecord> find_record(Connection& store, const std::string& id);
std::vector<JobState> find_states(Connection& store, const std::vector<std::string>& ids);
JobPage list_jobs(Connection& store, const JobQuery& query);
JobStore::Depth count_waiting(Connection& store);
std::optional<BatchSummary> find_batch(Connection& store, const std::string& id);
std::optional<std::string> find_batch_of_key(Connection& store, const std::string& owner, const std::string& key);
BatchPage list_batches(Connection& store, const std::optional<std::string>& owner, int limit,
                       std::optional<std::int64_t> before_seq);
std::vector<BatchRow> find_rows(Connection& store, const std::string& batch, std::int64_t from, std::size_t limit);

}  // namespace tunewright::server
