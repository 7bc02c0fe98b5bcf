#include "server/store/sqlite/reading.h"

#include <algorithm>

#include "server/store/sqlite/batch_changes.h"
#include "server/store/sqlite/job_changes.h"

namespace tunewright::server {
namespace {

constexpr int kSummaryCount = 20;

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
    job.outline = row.text(14);
    job.request_id = row.text(15);
    job.traceparent = row.text(16);
    job.settled = row.integer(17) != 0;
    job.not_before = row.moment(18);
}

}  // namespace

const std::string kStatus = "coalesce(e.status, iif(r.seq IS NULL, 'queued', 'running'))";
const std::string kAttempts = "coalesce(e.attempts, r.attempts, w.attempts, 0)";
const std::string kSummaryColumns = "j.seq, j.id, j.name, " + kStatus +
                                    ", j.created_at, coalesce(e.started_at, r.started_at), e.finished_at, " +
                                    kAttempts +
                                    ", j.timeout_s, j.request_hash, coalesce(e.cancel_requested, r.cancel_requested, "
                                    "0), j.owner, b.id, j.batch_index, e.outline, j.request_id, j.traceparent, "
                                    "j.request IS NULL OR coalesce(b.cancel_requested, 0), j.not_before, "
                                    "r.progress";
const std::string kRecordColumns = kSummaryColumns + ", j.request, e.result, e.error";
const std::string kJobTables =
    " FROM jobs j LEFT JOIN ended e ON e.seq = j.seq LEFT JOIN running r ON r.seq = j.seq "
    "LEFT JOIN waiting w ON w.class = j.class AND w.turn = j.turn AND w.seq = j.seq "
    "LEFT JOIN batches b ON b.seq = j.batch";
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

JobRecord read_claimed(Connection& store, std::int64_t seq) {
    Connection::Use row = store.use(
        "SELECT j.id, j.name, j.created_at, j.timeout_s, j.request_hash, j.owner, b.id, j.batch_index, j.request_id, "
        "j.traceparent, j.request, j.not_before, j.notify IS NOT NULL FROM jobs j LEFT JOIN batches b ON b.seq = "
        "j.batch WHERE j.seq = ?1");
    if (!row.with(seq).next()) throw StoreError({StoreFault::Kind::unavailable, "a job that waits is not there"});
    JobRecord job;
    job.seq = seq;
    job.status = JobStatus::running;
    job.id = row.text(0);
    job.name = row.text(1);
    job.created_at = row.integer(2);
    job.timeout_s = row.real(3);
    job.request_hash = row.text(4);
    job.owner = row.text(5);
    job.batch = row.text(6);
    job.index = row.integer(7);
    job.request_id = row.text(8);
    job.traceparent = row.text(9);
    job.request = row.text(10);
    job.not_before = row.moment(11);
    job.notifies = row.integer(12) != 0;
    return job;
}

const std::string kBatchColumns =
    "b.seq, b.id, b.name, b.owner, b.created_at, b.state = 'sealed', b.cancel_requested, b.queued, b.running, "
    "b.succeeded, b.failed, b.cancelled, b.last_end, b.traceparent";

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
    batch.traceparent = row.text(13);
    return batch;
}

std::optional<JobRecord> find_record(Connection& store, const std::string& id) {
    static const std::string sql = "SELECT " + kRecordColumns + kJobTables + " WHERE j.id = ?1 AND " + kVisible;
    Connection::Use row = store.use(sql);
    if (!row.with(id).next()) return std::nullopt;
    return read_record(row);
}

std::vector<JobState> find_states(Connection& store, const std::vector<std::string>& ids) {
    static const std::string sql = "SELECT " + kSummaryColumns + kJobTables + " WHERE j.id = ?1 AND " + kVisible;
    std::vector<JobState> states;
    for (const std::string& id : ids) {
        Connection::Use row = store.use(sql);
        if (row.with(id).next()) states.push_back(read_state(row));
    }
    return states;
}

std::optional<JobState> find_job_of_key(Connection& store, const std::string& owner, const std::string& key) {
    static const std::string sql =
        "SELECT " + kSummaryColumns + kJobTables + " WHERE j.owner = ?1 AND j.idempotency_key = ?2";
    Connection::Use row = store.use(sql);
    if (!row.with(owner, key).next()) return std::nullopt;
    return read_state(row);
}

namespace {

/// True if the jobs are found by the table of their state: few wait or run, and for those that have ended an index
/// gives the newest of a state. Entries of a batch that wait are found among all its entries.
bool found_by_state(const JobQuery& query) {
    return query.status && !(query.batch && *query.status == JobStatus::queued);
}

/// The tables; the one that selects the fewest jobs comes first.
std::string tables_of(const JobQuery& query) {
    if (!found_by_state(query)) return kJobTables;
    std::string tables = kJobTables;
    const auto first = [&](const std::string& join, const std::string& table) {
        tables.replace(tables.find(join), join.size(), "");
        tables.replace(tables.find(" FROM jobs j"), 12,
                       " FROM " + table + " CROSS JOIN jobs j ON j.seq = " + table.back() + ".seq");
    };
    if (*query.status == JobStatus::queued)
        first(" LEFT JOIN waiting w ON w.class = j.class AND w.turn = j.turn AND w.seq = j.seq", "waiting w");
    else if (*query.status == JobStatus::running)
        first(" LEFT JOIN running r ON r.seq = j.seq", "running r");
    else
        first(" LEFT JOIN ended e ON e.seq = j.seq", "ended e");
    return tables;
}

/// The number that orders the list, from the table by which jobs are found. The entries of a batch are ordered by their
/// index, which is also the order of their seq.
std::string order_of(const JobQuery& query) {
    if (!found_by_state(query)) return query.batch ? "j.batch_index" : "j.seq";
    if (*query.status == JobStatus::queued) return "w.seq";
    return *query.status == JobStatus::running ? "r.seq" : "e.seq";
}

/// "" if the table implies it.
std::string status_condition(const JobQuery& query) {
    if (!found_by_state(query)) return " AND " + kStatus + " = ?2";
    if (*query.status == JobStatus::queued) return " AND w.batch IS NULL";
    const std::string ended = has_ended(*query.status) ? " AND e.status = ?2" : "";
    if (!query.batch) return ended.empty() ? "" : " AND e.single" + ended;
    const std::string entry =
        "(SELECT seq FROM jobs WHERE batch = (SELECT seq FROM batches WHERE id = ?1) ORDER BY batch_index ";
    return (ended.empty() ? "" : " AND NOT e.single" + ended) + " AND " + order_of(query) + " BETWEEN " + entry +
           "LIMIT 1) AND " + entry + "DESC LIMIT 1)";
}

}  // namespace

JobPage list_jobs(Connection& store, const JobQuery& query) {
    const std::string order = order_of(query);
    std::string sql = "SELECT " + kSummaryColumns + tables_of(query);
    sql += query.batch ? " WHERE j.batch = (SELECT seq FROM batches WHERE id = ?1 AND state <> 'leaving')"
                       : " WHERE j.batch IS NULL";
    const std::string of_status = query.status ? status_condition(query) : std::string{};
    sql += of_status;
    if (query.name) sql += query.batch ? " AND j.name = ?3" : " AND j.name = ?3 AND j.name <> ''";
    if (query.owner) sql += query.owner->empty() ? " AND j.owner = ?4" : " AND j.owner = ?4 AND j.owner <> ''";
    if (query.text)
        sql +=
            " AND (instr(lower(j.name), lower(?7)) > 0 OR instr(j.id, lower(?7)) > 0 OR "
            "instr(json_extract(e.outline, '$.method'), lower(?7)) > 0)";
    if (query.before_seq)
        sql +=
            " AND " + order + (order == "j.batch_index" ? " < (SELECT batch_index FROM jobs WHERE seq = ?5)" : " < ?5");
    sql += " ORDER BY " + order + " DESC LIMIT ?6";
    Connection::Use row = store.use(sql);
    const std::string status(query.status ? to_string(*query.status) : "");
    if (query.batch) row.bind(1, *query.batch);
    if (of_status.find("?2") != std::string::npos) row.bind(2, status);
    if (query.name) row.bind(3, *query.name);
    if (query.owner) row.bind(4, *query.owner);
    if (query.before_seq) row.bind(5, *query.before_seq);
    row.bind(6, query.limit + 1);
    if (query.text) row.bind(7, *query.text);
    JobPage page;
    while (row.next()) page.jobs.push_back(read_summary(row));
    page.more = page.jobs.size() > static_cast<std::size_t>(query.limit);
    if (page.more) page.jobs.pop_back();
    return page;
}

namespace {

std::optional<UnixMs> next_accepted(Connection& store, int priority) {
    Connection::Use row = store.use(
        "SELECT max(j.created_at, coalesce(j.not_before, 0)) FROM waiting w JOIN jobs j ON j.seq = w.seq "
        "WHERE w.class = ?1 ORDER BY w.turn, w.seq LIMIT 1");
    if (!row.with(priority).next()) return std::nullopt;
    return row.integer(0);
}

std::size_t count(Connection& store, std::string_view sql) { return static_cast<std::size_t>(store.number(sql)); }

}  // namespace

std::string pause_over(const std::string& now) {
    const std::string longest = std::to_string(std::chrono::milliseconds(kLongestPause).count());
    return "(not_before <= " + now + " OR not_before > " + now + " + " + longest + ")";
}

QueueDepth count_waiting(Connection& store) {
    QueueDepth depth;
    depth.next_single = next_accepted(store, 0);
    depth.next_entry = next_accepted(store, 1);
    depth.single = count(store, "SELECT count(*) FROM waiting WHERE batch IS NULL");
    // Batches have counts of their entries; entries of a batch that is being deleted no longer wait.
    depth.entries = count(store,
                          "SELECT coalesce(sum(queued), 0) FROM batches WHERE ended_at IS NULL "
                          "AND state <> 'leaving'");
    static const std::string suspects =
        "SELECT count(*) FROM waiting WHERE crashes > 1 AND " + pause_over("(julianday('now') - 2440587.5) * 86400000");
    depth.suspects = count(store, suspects);
    depth.paused = is_paused(store);
    return depth;
}

std::optional<BatchSummary> find_batch(Connection& store, const std::string& id) {
    static const std::string sql =
        "SELECT " + kBatchColumns + " FROM batches b WHERE b.id = ?1 AND b.state <> 'leaving'";
    Connection::Use row = store.use(sql);
    if (!row.with(id).next()) return std::nullopt;
    return read_batch(row);
}

std::optional<std::string> find_batch_of_key(Connection& store, const std::string& owner, const std::string& key) {
    Connection::Use row = store.use("SELECT id FROM batches WHERE owner = ?1 AND idempotency_key = ?2");
    if (!row.with(owner, key).next()) return std::nullopt;
    return row.text(0);
}

BatchPage list_batches(Connection& store, const std::optional<std::string>& owner, int limit,
                       std::optional<std::int64_t> before_seq) {
    std::string sql = "SELECT " + kBatchColumns + " FROM batches b WHERE b.state <> 'leaving'";
    if (owner) sql += owner->empty() ? " AND b.owner = ?1" : " AND b.owner = ?1 AND b.owner <> ''";
    if (before_seq) sql += " AND b.seq < ?2";
    sql += " ORDER BY b.seq DESC LIMIT ?3";
    Connection::Use row = store.use(sql);
    if (owner) row.bind(1, *owner);
    if (before_seq) row.bind(2, *before_seq);
    row.bind(3, limit + 1);
    BatchPage page;
    while (row.next()) page.batches.push_back(read_batch(row));
    page.more = page.batches.size() > static_cast<std::size_t>(limit);
    if (page.more) page.batches.pop_back();
    return page;
}

std::vector<BatchRow> find_rows(Connection& store, const std::string& batch, std::int64_t from, std::size_t limit) {
    static const std::string sql =
        "SELECT j.batch_index, j.id, j.name, " + kStatus +
        ", e.result, e.error FROM jobs j LEFT JOIN ended e ON e.seq = j.seq LEFT JOIN running r ON r.seq = j.seq "
        "WHERE j.batch = (SELECT seq FROM batches WHERE id = ?1 AND state <> 'leaving') AND j.batch_index >= ?2 "
        "ORDER BY j.batch_index LIMIT ?3";
    Connection::Use row = store.use(sql);
    row.with(batch, from, static_cast<std::int64_t>(limit));
    std::vector<BatchRow> rows;
    for (std::size_t bytes = 0; bytes < BatchStore::kRowsBytes && row.next();) {
        BatchRow entry{row.integer(0), row.text(1), row.text(2), job_status(row.text(3)).value(),
                       row.text(4),    row.text(5)};
        bytes += entry.result.size() + entry.error.size();
        rows.push_back(std::move(entry));
    }
    return rows;
}

}  // namespace tunewright::server
