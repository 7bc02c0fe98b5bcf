#include "server/store/postgres/rows.h"

#include <algorithm>

#include "server/store/postgres/text.h"

namespace tunewright::server::postgres {
namespace {

constexpr int kSummaryCount = 15;

std::optional<UnixMs> moment(const pqxx::field& field) {
    return field.is_null() ? std::nullopt : std::optional<UnixMs>(field.as<UnixMs>());
}

void fill_summary(const pqxx::row& row, JobSummary& job) {
    job.seq = row[0].as<std::int64_t>();
    job.id = text_of(row[1]);
    job.name = text_of(row[2]);
    job.status = job_status(row[3].c_str()).value();
    job.created_at = row[4].as<UnixMs>();
    job.started_at = moment(row[5]);
    job.finished_at = moment(row[6]);
    job.attempts = row[7].as<int>();
    job.timeout_s = row[8].as<double>();
    job.request_hash = text_of(row[9]);
    job.cancel_requested = row[10].as<bool>();
    job.owner = text_of(row[11]);
    job.batch = text_of(row[12]);
    job.index = row[13].is_null() ? 0 : row[13].as<std::int64_t>();
}

}  // namespace

const std::string kSummaryColumns =
    "j.seq, j.id, j.name, j.status, j.created_at, j.started_at, j.finished_at, j.attempts, j.timeout_s, "
    "j.request_hash, j.cancel_requested, j.owner, b.id, j.batch_index, "
    "CASE WHEN j.progress_attempts = j.attempts THEN j.progress END";
const std::string kRecordColumns = kSummaryColumns + ", j.request, j.result, j.error";
const std::string kTables = " FROM jobs j LEFT JOIN batches b ON b.seq = j.batch";
const std::string kVisible = "(j.batch IS NULL OR b.state <> 'leaving')";

std::string text_of(const pqxx::field& field) {
    return field.is_null() ? std::string{} : from_column({field.c_str(), field.size()});
}

JobSummary read_summary(const pqxx::row& row) {
    JobSummary job;
    fill_summary(row, job);
    return job;
}

JobState read_state(const pqxx::row& row) {
    JobState job;
    fill_summary(row, job);
    job.progress = text_of(row[kSummaryCount - 1]);
    return job;
}

JobRecord read_record(const pqxx::row& row) {
    JobRecord job;
    fill_summary(row, job);
    job.progress = text_of(row[kSummaryCount - 1]);
    job.request = text_of(row[kSummaryCount]);
    job.result = text_of(row[kSummaryCount + 1]);
    job.error = text_of(row[kSummaryCount + 2]);
    return job;
}

const std::string kBatchColumns =
    "b.seq, b.id, b.name, b.owner, b.created_at, b.state = 'sealed', b.cancel_requested, coalesce(sum(c.queued), 0), "
    "coalesce(sum(c.running), 0), coalesce(sum(c.succeeded), 0), coalesce(sum(c.failed), 0), "
    "coalesce(sum(c.cancelled), 0), coalesce(max(c.last_end), 0)";
const std::string kBatchTables = " FROM batches b LEFT JOIN batch_counts c ON c.batch = b.seq";
const std::string kBatchGroups = " GROUP BY b.seq";

BatchSummary read_batch(const pqxx::row& row) {
    BatchSummary batch;
    batch.seq = row[0].as<std::int64_t>();
    batch.id = text_of(row[1]);
    batch.name = text_of(row[2]);
    batch.owner = text_of(row[3]);
    batch.created_at = row[4].as<UnixMs>();
    batch.sealed = row[5].as<bool>();
    batch.cancel_requested = row[6].as<bool>();
    const auto count = [&](int column) { return static_cast<std::size_t>(row[column].as<std::int64_t>()); };
    batch.queued = count(7);
    batch.running = count(8);
    batch.succeeded = count(9);
    batch.failed = count(10);
    batch.cancelled = count(11);
    batch.total = batch.queued + batch.running + batch.succeeded + batch.failed + batch.cancelled;
    if (batch.ended()) batch.finished_at = std::max(row[12].as<UnixMs>(), batch.created_at);
    return batch;
}

}  // namespace tunewright::server::postgres
