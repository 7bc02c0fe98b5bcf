#include "server/store/sqlite/rows.h"

#include <algorithm>

namespace tunewright::server {
namespace {

constexpr int kSummaryCount = 15;

void fill_summary(const Connection::Use& row, JobSummary& job) {
    job.seq = row.integer(0);
    job.id = row.text(1);
    job.name = row.text(2);
    job.status = job_status(row.text(3)).value();
    job.created_at = row.integer(4);
    job.started_at = row.moment(5);
    job.finished_at = row.moment(6);
    job.attempts = static_cast<int>(row.integer(7));
    job.timeout_s = row.real(8);
    job.request_hash = row.text(9);
    job.cancel_requested = row.integer(10) != 0;
    job.owner = row.text(11);
    job.batch = row.text(12);
    job.index = row.integer(13);
}

}  // namespace

const std::string kSummaryColumns =
    "j.seq, j.id, j.name, j.status, j.created_at, j.started_at, j.finished_at, j.attempts, j.timeout_s, "
    "j.request_hash, j.cancel_requested, j.owner, b.id, j.batch_index, p.body";
const std::string kSummaryTables =
    " FROM jobs j LEFT JOIN batches b ON b.seq = j.batch "
    "LEFT JOIN progress p ON p.seq = j.seq AND p.attempts = j.attempts";
const std::string kRecordColumns = kSummaryColumns + ", q.body, r.body, r.error";
const std::string kRecordTables =
    kSummaryTables + " LEFT JOIN requests q ON q.seq = j.seq LEFT JOIN results r ON r.seq = j.seq";
const std::string kVisible = "(j.batch IS NULL OR b.state <> 'leaving')";

JobSummary read_summary(const Connection::Use& row) {
    JobSummary job;
    fill_summary(row, job);
    return job;
}

JobState read_state(const Connection::Use& row) {
    JobState job;
    fill_summary(row, job);
    job.progress = row.text(kSummaryCount - 1);
    return job;
}

JobRecord read_record(const Connection::Use& row) {
    JobRecord job;
    fill_summary(row, job);
    job.progress = row.text(kSummaryCount - 1);
    job.request = row.text(kSummaryCount);
    job.result = row.text(kSummaryCount + 1);
    job.error = row.text(kSummaryCount + 2);
    return job;
}

const std::string kBatchColumns =
    "b.seq, b.id, b.name, b.owner, b.created_at, b.state = 'sealed', b.cancel_requested, b.queued, b.running, "
    "b.succeeded, b.failed, b.cancelled, b.last_end";

BatchSummary read_batch(const Connection::Use& row) {
    BatchSummary batch;
    batch.seq = row.integer(0);
    batch.id = row.text(1);
    batch.name = row.text(2);
    batch.owner = row.text(3);
    batch.created_at = row.integer(4);
    batch.sealed = row.integer(5) != 0;
    batch.cancel_requested = row.integer(6) != 0;
    const auto count = [&](int column) { return static_cast<std::size_t>(row.integer(column)); };
    batch.queued = count(7);
    batch.running = count(8);
    batch.succeeded = count(9);
    batch.failed = count(10);
    batch.cancelled = count(11);
    batch.total = batch.queued + batch.running + batch.succeeded + batch.failed + batch.cancelled;
    if (batch.ended()) batch.finished_at = std::max(row.integer(12), batch.created_at);
    return batch;
}

}  // namespace tunewright::server
