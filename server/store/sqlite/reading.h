// What is read from the file, one statement each. Every function runs on a connection that only reads.
#pragma once

#include <string>
#include <vector>

#include "server/store/sqlite/connection.h"

namespace tunewright::server {

/// The job with request, result and progress; nothing where there is none, or its batch is being deleted.
std::optional<JobRecord> find_record(Connection& store, const std::string& id);
/// The states of those of the jobs that there are, in no particular order.
std::vector<JobState> find_states(Connection& store, const std::vector<std::string>& ids);
/// A page of jobs, newest first, as `query` asks for.
JobPage list_jobs(Connection& store, const JobQuery& query);
/// How many single jobs, and how many entries of batches, wait.
JobStore::Depth count_waiting(Connection& store);
/// A batch that is not being deleted.
std::optional<BatchSummary> find_batch(Connection& store, const std::string& id);
/// The id of the batch that `owner` posted under this idempotency key.
std::optional<std::string> find_batch_of_key(Connection& store, const std::string& owner, const std::string& key);
/// A page of batches, newest first: those before `before_seq`, of `owner` alone where one is given.
BatchPage list_batches(Connection& store, const std::optional<std::string>& owner, int limit,
                       std::optional<std::int64_t> before_seq);
/// At most `limit` rows of a batch's results in the order of its entries, beginning with index `from`.
std::vector<BatchRow> find_rows(Connection& store, const std::string& batch, std::int64_t from, std::size_t limit);

}  // namespace tunewright::server
