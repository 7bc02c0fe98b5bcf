// Reads the database: jobs and batches as rows of the tables, in the only place that knows the order of the columns,
// and the queries of the store, one statement each.
#pragma once

#include <pqxx/row>
#include <string>
#include <vector>

#include "server/store/postgres/session.h"
#include "server/store/store.h"

namespace tunewright::server::postgres {

/// The state of job j, in terms of the tables below.
extern const std::string kStatus;
/// Columns of a summary, of a state (with progress), and of a record. "SELECT " + columns + kJobTables.
extern const std::string kSummaryColumns;
extern const std::string kRecordColumns;
extern const std::string kJobTables;
/// Columns of a job that has just been claimed, of `runs r`, `jobs j` and `batches b`; and their number.
extern const std::string kClaimedColumns;
constexpr int kClaimedCount = 16;
/// True for visible jobs: those of a batch that is being deleted are not.
extern const std::string kVisible;
/// Condition for a job that waits after crashes: its pause is over, or is longer than any pause, because the clock has
/// been set back since.
extern const std::string kPauseOver;

JobSummary read_summary(const pqxx::row& row);
JobState read_state(const pqxx::row& row);
JobRecord read_record(const pqxx::row& row);
JobRecord read_claimed(const pqxx::row& row);

/// "SELECT " + these + conditions on `b` + kBatchGroups.
extern const std::string kBatchColumns;
extern const std::string kBatchTables;
extern const std::string kBatchGroups;
BatchSummary read_batch(const pqxx::row& row);

/// Empty if the field is null.
std::optional<UnixMs> moment(const pqxx::field& field);
/// "" if the field is null.
std::string text_of(const pqxx::field& field);

/// The job with request, result and progress; empty if there is none, or its batch is being deleted.
std::optional<JobRecord> find_record(Session& session, const std::string& id);
/// The states of the existing ones of these jobs, in no particular order.
std::vector<JobState> find_states(Session& session, const std::vector<std::string>& ids);
std::optional<JobState> find_job_of_key(Session& session, const std::string& owner, const std::string& key);
/// A page of jobs, newest first, as `query` asks for.
JobPage list_jobs(Session& session, const JobQuery& query);
struct Counted {
    QueueDepth depth;
    UnixMs clock = 0;  ///< the database's
};
/// The number of single jobs, and of entries of batches, that wait.
Counted count_waiting(Session& session);
/// A batch that is not being deleted.
std::optional<BatchSummary> find_batch(Session& session, const std::string& id);
/// The id of the batch that `owner` posted under this idempotency key.
std::optional<std::string> find_batch_of_key(Session& session, const std::string& owner, const std::string& key);
/// A page of batches, newest first: those before `before_seq`, of `owner` alone where one is given.
BatchPage list_batches(Session& session, const std::optional<std::string>& owner, int limit,
                       std::optional<std::int64_t> before_seq);
/// At most `limit` rows of a batch's results in the order of its entries, beginning with index `from`.
std::vector<BatchRow> find_rows(Session& session, const std::string& batch, std::int64_t from, std::size_t limit);

}  // namespace tunewright::server::postgres
