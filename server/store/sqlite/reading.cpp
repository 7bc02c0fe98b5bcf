#include "server/store/sqlite/reading.h"

#include <algorithm>

namespace tunewright::server {
namespace {

constexpr int kSummaryCount = 16;

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
}

}  // namespace

const std::string kSummaryColumns =
    "j.seq, j.id, j.name, j.status, j.created_at, j.started_at, j.finished_at, j.attempts, j.timeout_s, "
    "j.request_hash, j.cancel_requested, j.owner, b.id, j.batch_index, j.outline, p.body";
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

std::optional<JobRecord> find_record(Connection& store, const std::string& id) {
    static const std::string sql = "SELECT " + kRecordColumns + kRecordTables + " WHERE j.id = ?1 AND " + kVisible;
    Connection::Use row = store.use(sql);
    if (!row.with(id).next()) return std::nullopt;
    return read_record(row);
}

std::vector<JobState> find_states(Connection& store, const std::vector<std::string>& ids) {
    static const std::string sql = "SELECT " + kSummaryColumns + kSummaryTables + " WHERE j.id = ?1 AND " + kVisible;
    std::vector<JobState> states;
    for (const std::string& id : ids) {
        Connection::Use row = store.use(sql);
        if (row.with(id).next()) states.push_back(read_state(row));
    }
    return states;
}

JobPage list_jobs(Connection& store, const JobQuery& query) {
    // The entries of a batch stand in the order of their index, which is that of their seq too.
    std::string sql = "SELECT " + kSummaryColumns + kSummaryTables;
    sql += query.batch ? " WHERE j.batch = (SELECT seq FROM batches WHERE id = ?1 AND state <> 'leaving')"
                       : " WHERE j.class = 0";
    if (query.status) sql += " AND j.status = ?2";
    if (query.name) sql += " AND j.name = ?3";
    if (query.owner) sql += " AND j.owner = ?4";
    if (query.text)
        sql +=
            " AND (instr(lower(j.name), lower(?7)) > 0 OR instr(j.id, lower(?7)) > 0 OR "
            "instr(json_extract(j.outline, '$.method'), lower(?7)) > 0)";
    if (query.before_seq)
        sql += query.batch ? " AND j.batch_index < (SELECT batch_index FROM jobs WHERE seq = ?5)" : " AND j.seq < ?5";
    sql += query.batch ? " ORDER BY j.batch_index DESC" : " ORDER BY j.seq DESC";
    sql += " LIMIT ?6";
    Connection::Use row = store.use(sql);
    const std::string status(query.status ? to_string(*query.status) : "");
    if (query.batch) row.bind(1, *query.batch);
    if (query.status) row.bind(2, status);
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

std::optional<UnixMs> next_accepted(Connection& store, int job_class) {
    Connection::Use row =
        store.use("SELECT created_at FROM jobs WHERE status = 'queued' AND class = ?1 ORDER BY turn, seq LIMIT 1");
    if (!row.with(job_class).next()) return std::nullopt;
    return row.integer(0);
}

}  // namespace

JobStore::Depth count_waiting(Connection& store) {
    JobStore::Depth depth;
    depth.next_single = next_accepted(store, 0);
    depth.next_entry = next_accepted(store, 1);
    depth.single =
        static_cast<std::size_t>(store.number("SELECT count(*) FROM jobs WHERE status = 'queued' AND class = 0"));
    // Batches count their entries themselves; those of one that is leaving wait no longer.
    depth.entries =
        static_cast<std::size_t>(store.number("SELECT coalesce(sum(queued), 0) FROM batches WHERE state <> 'leaving'"));
    depth.suspects =
        static_cast<std::size_t>(store.number("SELECT count(*) FROM jobs WHERE status = 'queued' AND crashes > 1 "
                                              "AND not_before <= (julianday('now') - 2440587.5) * 86400000"));
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
    Connection::Use row =
        store.use("SELECT b.id FROM batch_keys k JOIN batches b ON b.seq = k.batch WHERE k.owner = ?1 AND k.key = ?2");
    if (!row.with(owner, key).next()) return std::nullopt;
    return row.text(0);
}

BatchPage list_batches(Connection& store, const std::optional<std::string>& owner, int limit,
                       std::optional<std::int64_t> before_seq) {
    std::string sql = "SELECT " + kBatchColumns + " FROM batches b WHERE b.state <> 'leaving'";
    if (owner) sql += " AND b.owner = ?1";
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
    Connection::Use row = store.use(
        "SELECT j.batch_index, j.id, j.name, j.status, r.body, r.error FROM jobs j LEFT JOIN results r ON r.seq = "
        "j.seq "
        "WHERE j.batch = (SELECT seq FROM batches WHERE id = ?1 AND state <> 'leaving') AND j.batch_index >= ?2 "
        "ORDER BY j.batch_index LIMIT ?3");
    row.with(batch, from, static_cast<std::int64_t>(limit));
    std::vector<BatchRow> rows;
    while (row.next()) {
        BatchRow entry{row.integer(0), row.text(1), row.text(2), job_status(row.text(3)).value(),
                       row.text(4),    row.text(5)};
        rows.push_back(std::move(entry));
    }
    return rows;
}

}  // namespace tunewright::server
