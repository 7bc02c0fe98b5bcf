// Reads the file: jobs and batches as rows of the tables, in the only place that knows the order of the columns, and
// the queries of the store, one statement each.
#pragma once

#include <string>
#include <vector>

#include "server/store/sqlite/connection.h"

namespace tunewright::server {

/// The state of job j and its attempts, in terms of the tables below.
extern const std::string kStatus;
extern const std::string kAttempts;
/// Columns of a summary, of a state (with progress), and of a record. "SELECT " + columns + kJobTables.
extern const std::string kSummaryColumns;
extern const std::string kRecordColumns;
extern const std::string kJobTables;
/// True for visible jobs: those of a batch that is being deleted are not.
extern const std::string kVisible;

/// Reads the current row of a query that selects the columns of the same name.
JobSummary read_summary(const Connection::Use& row);
JobState read_state(const Connection::Use& row);
JobRecord read_record(const Connection::Use& row);
/// A job that has just been claimed: its constant data and its request.
JobRecord read_claimed(Connection& store, std::int64_t seq);

/// Columns of a batch, of `batches b`.
extern const std::string kBatchColumns;
BatchSummary read_batch(const Connection::Use& row);

// The queries. Each runs on a connection that only reads. The job with request, result and progress; empty if there is
// none, or its batch is being deleted.
std::optional<JobRecord> find_record(Connection& store, const std::string& id);
/// The states of the existing ones of these jobs, in no particular order.
std::vector<JobState> find_states(Connection& store, const std::vector<std::string>& ids);
std::optional<JobState> find_job_of_key(Connection& store, const std::string& owner, const std::string& key);
/// A page of jobs, newest first, as `query` asks for.
JobPage list_jobs(Connection& store, const JobQuery& query);
/// The number of single jobs, and of entries of batches, that wait.
QueueDepth count_waiting(Connection& store);
/// A condition for a job that waits after crashes: its pause is over at `now`, an expression, or is longer than any
/// pause, because the clock has been set back since.
std::string pause_over(const std::string& now);
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
