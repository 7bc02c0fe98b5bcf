#include "server/store/postgres/reading.h"

#include <algorithm>

#include "server/store/postgres/text.h"

namespace tunewright::server::postgres {
namespace {

constexpr int kSummaryCount = 20;

/// Each process knows the database's clock only to some milliseconds: a job that one began and another ended must not
/// end before it began.
std::optional<UnixMs> moment_after(UnixMs earlier, const pqxx::field& field) {
    const auto at = moment(field);
    return at ? std::optional(std::max(*at, earlier)) : std::nullopt;
}

void fill_summary(const pqxx::row& row, JobSummary& job) {
    job.seq = row[0].as<std::int64_t>();
    job.id = text_of(row[1]);
    job.name = text_of(row[2]);
    job.status = job_status(row[3].c_str()).value();
    job.created_at = row[4].as<UnixMs>();
    job.started_at = moment_after(job.created_at, row[5]);
    job.finished_at = moment_after(job.started_at.value_or(job.created_at), row[6]);
    job.attempts = row[7].as<int>();
    job.timeout_s = row[8].as<double>();
    job.request_hash = text_of(row[9]);
    job.cancel_requested = row[10].as<bool>();
    job.owner = text_of(row[11]);
    job.batch = text_of(row[12]);
    job.index = row[13].is_null() ? 0 : row[13].as<std::int64_t>();
    job.outline = text_of(row[14]);
    job.request_id = text_of(row[15]);
    job.traceparent = text_of(row[16]);
    job.settled = row[17].as<bool>();
    job.not_before = moment(row[18]);
}

}  // namespace

const std::string kStatus = "coalesce(e.status, CASE WHEN r.seq IS NULL THEN 'queued' ELSE 'running' END)";
const std::string kSummaryColumns = "j.seq, j.id, j.name, " + kStatus +
                                    ", j.created_at, coalesce(e.started_at, r.started_at), e.finished_at, "
                                    "coalesce(e.attempts, r.attempts, w.attempts, 0), j.timeout_s, j.request_hash, "
                                    "coalesce(e.cancel_requested, r.cancel_requested, false), j.owner, b.id, "
                                    "j.batch_index, e.outline, j.request_id, j.traceparent, "
                                    "j.request IS NULL OR coalesce(b.cancel_requested, false), j.not_before, "
                                    "r.progress";
const std::string kRecordColumns = kSummaryColumns + ", j.request, e.result, e.error";
// A job that has ended is in no other table: those are then not searched.
const std::string kEnded = " LEFT JOIN ended e ON e.seq = j.seq";
const std::string kRunning =
    " LEFT JOIN LATERAL (SELECT * FROM running WHERE seq = j.seq AND e.seq IS NULL OFFSET 0) r ON true";
const std::string kWaiting =
    " LEFT JOIN LATERAL (SELECT * FROM waiting WHERE class = j.class AND turn = j.turn AND seq = j.seq "
    "AND e.seq IS NULL OFFSET 0) w ON true";
const std::string kBatch = " LEFT JOIN batches b ON b.seq = j.batch";
const std::string kJobTables = " FROM jobs j" + kEnded + kRunning + kWaiting + kBatch;
const std::string kClaimedColumns =
    "j.seq, j.id, j.name, j.created_at, r.started_at, r.attempts, j.timeout_s, j.request_hash, j.owner, b.id, "
    "j.batch_index, j.request_id, j.traceparent, j.request, j.not_before, j.notify IS NOT NULL";
const std::string kVisible = "(j.batch IS NULL OR b.state <> 'leaving')";

std::optional<UnixMs> moment(const pqxx::field& field) {
    return field.is_null() ? std::nullopt : std::optional<UnixMs>(field.as<UnixMs>());
}

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

JobRecord read_claimed(const pqxx::row& row) {
    JobRecord job;
    job.seq = row[0].as<std::int64_t>();
    job.id = text_of(row[1]);
    job.name = text_of(row[2]);
    job.status = JobStatus::running;
    job.created_at = row[3].as<UnixMs>();
    job.started_at = moment(row[4]);
    job.attempts = row[5].as<int>();
    job.timeout_s = row[6].as<double>();
    job.request_hash = text_of(row[7]);
    job.owner = text_of(row[8]);
    job.batch = text_of(row[9]);
    job.index = row[10].is_null() ? 0 : row[10].as<std::int64_t>();
    job.request_id = text_of(row[11]);
    job.traceparent = text_of(row[12]);
    job.request = text_of(row[13]);
    job.not_before = moment(row[14]);
    job.notifies = row[15].as<bool>();
    return job;
}

const std::string kPauseOver = "(not_before <= clock_timestamp() OR not_before > clock_timestamp() + " +
                               std::to_string(std::chrono::milliseconds(kLongestPause).count()) +
                               " * interval '1 millisecond')";

const std::string kBatchColumns =
    "b.seq, b.id, b.name, b.owner, b.created_at, b.state = 'sealed', b.cancel_requested, coalesce(sum(c.queued), 0), "
    "coalesce(sum(c.running), 0), coalesce(sum(c.succeeded), 0), coalesce(sum(c.failed), 0), "
    "coalesce(sum(c.cancelled), 0), coalesce(max(c.last_end), 0), b.traceparent";
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
    batch.traceparent = text_of(row[13]);
    return batch;
}

namespace {

/// A SELECT that is built condition by condition, with the values of its parameters.
class Query {
public:
    explicit Query(std::string sql) : sql_(std::move(sql)) {}
    /// The next parameter, as "$2".
    std::string text(const std::string& value) {
        values_.text(value);
        return "$" + std::to_string(values_.list.size());
    }
    std::string number(std::int64_t value) {
        values_.number(value);
        return "$" + std::to_string(values_.list.size());
    }
    Query& operator+=(const std::string& sql) {
        sql_ += sql;
        return *this;
    }
    Query around(const std::string& before, const std::string& after) const {
        Query whole(*this);
        whole.sql_ = before + sql_ + after;
        return whole;
    }
    pqxx::result run(Session& session) const { return session.run(sql_, values_); }

private:
    std::string sql_;
    Values values_;
};

const std::string kBatchOfId = "(SELECT seq FROM batches WHERE state <> 'leaving' AND id = ";

}  // namespace

std::optional<JobRecord> find_record(Session& session, const std::string& id) {
    static const std::string sql = "SELECT " + kRecordColumns + kJobTables + " WHERE j.id = $1 AND " + kVisible;
    const pqxx::result rows = session.run(sql, Values().text(id));
    if (rows.empty()) return std::nullopt;
    return read_record(rows[0]);
}

std::vector<JobState> find_states(Session& session, const std::vector<std::string>& ids) {
    static const std::string sql =
        "SELECT " + kSummaryColumns + kJobTables + " WHERE j.id = ANY ($1::text[]) AND " + kVisible;
    TextArray wanted;
    for (const std::string& id : ids) wanted.add(id);
    std::vector<JobState> states;
    for (const pqxx::row& row : session.run(sql, Values().plain(wanted.literal()))) states.push_back(read_state(row));
    return states;
}

std::optional<JobState> find_job_of_key(Session& session, const std::string& owner, const std::string& key) {
    static const std::string sql =
        "SELECT " + kSummaryColumns + kJobTables + " WHERE j.owner = $1 AND j.idempotency_key = $2";
    const pqxx::result rows = session.run(sql, Values().text(owner).text(key));
    if (rows.empty()) return std::nullopt;
    return read_state(rows[0]);
}

namespace {

/// True if the jobs are found by the table of their state: few wait or run, and for those that have ended an index
/// gives the newest of a state. Entries of a batch that wait or run are found among all its entries.
bool found_by_state(const JobQuery& query) { return query.status && (!query.batch || has_ended(*query.status)); }

std::string status_condition(const JobQuery& query, const std::string& name) {
    if (!found_by_state(query)) return " AND " + kStatus + " = " + name;
    if (*query.status == JobStatus::queued) return " AND w.batch IS NULL AND " + name + " <> ''";
    if (*query.status == JobStatus::running) return " AND " + name + " <> ''";
    return query.batch ? "" : " AND e.single AND e.status = " + name;
}

/// The number that orders the list, from the table by which jobs are found. The entries of a batch are ordered by their
/// index, which is also the order of their seq.
std::string order_of(const JobQuery& query) {
    if (!found_by_state(query)) return query.batch ? "j.batch_index" : "j.seq";
    if (*query.status == JobStatus::queued) return "w.seq";
    return *query.status == JobStatus::running ? "r.seq" : "e.seq";
}

std::string tables_of(const JobQuery& query, const std::string& status) {
    if (!found_by_state(query)) return kJobTables;
    if (*query.status == JobStatus::queued)
        return " FROM waiting w JOIN jobs j ON j.seq = w.seq" + kEnded + kRunning + kBatch;
    if (*query.status == JobStatus::running)
        return " FROM running r JOIN jobs j ON j.seq = r.seq" + kEnded + kWaiting + kBatch;
    if (!query.batch) return " FROM ended e JOIN jobs j ON j.seq = e.seq" + kRunning + kWaiting + kBatch;
    const std::string entry = "(SELECT seq FROM jobs WHERE batch = " + kBatchOfId + "$1) ORDER BY batch_index ";
    // OFFSET 0 prevents the planner from checking every entry of the batch instead.
    return " FROM (SELECT * FROM ended WHERE NOT single AND status = " + status + " AND seq BETWEEN " + entry +
           "LIMIT 1) AND " + entry +
           "DESC LIMIT 1) ORDER BY seq DESC OFFSET 0) e CROSS JOIN LATERAL "
           "(SELECT * FROM jobs WHERE seq = e.seq OFFSET 0) j" +
           kRunning + kWaiting + kBatch;
}

}  // namespace

JobPage list_jobs(Session& session, const JobQuery& query) {
    const std::string order = order_of(query);
    Query sql("SELECT " + kSummaryColumns);
    const std::string batch = query.batch ? sql.text(*query.batch) : std::string();
    const std::string status = query.status ? sql.text(std::string(to_string(*query.status))) : std::string();
    sql += tables_of(query, status);
    sql += query.batch ? " WHERE j.batch = " + kBatchOfId + batch + ")" : " WHERE j.batch IS NULL";
    if (query.status) sql += status_condition(query, status);
    if (query.name) sql += " AND j.name = " + sql.text(*query.name) + (query.name->empty() ? "" : " AND j.name <> ''");
    if (query.owner)
        sql += " AND j.owner = " + sql.text(*query.owner) + (query.owner->empty() ? "" : " AND j.owner <> ''");
    if (query.text) {
        const std::string part = "lower(" + sql.text(*query.text) + "::text)";
        sql += " AND (strpos(lower(j.name), " + part + ") > 0 OR strpos(j.id, " + part +
               ") > 0 OR strpos(e.outline::jsonb ->> 'method', " + part + ") > 0)";
    }
    if (query.before_seq) {
        const std::string before = sql.number(*query.before_seq);
        sql += " AND " + order + " < " +
               (order == "j.batch_index" ? "(SELECT batch_index FROM jobs WHERE seq = " + before + ")" : before);
    }
    sql += " ORDER BY " + order + " DESC LIMIT " + sql.number(query.limit + 1);
    JobPage page;
    for (const pqxx::row& row : sql.run(session)) page.jobs.push_back(read_summary(row));
    page.more = page.jobs.size() > static_cast<std::size_t>(query.limit);
    if (page.more) page.jobs.pop_back();
    return page;
}

Counted count_waiting(Session& session) {
    const std::string head =
        "(SELECT greatest(j.created_at, j.not_before) FROM waiting w JOIN jobs j ON j.seq = w.seq WHERE w.class = ";
    const std::string order = " ORDER BY w.class, w.turn, w.seq LIMIT 1)";
    const pqxx::row row = session.run(
        "SELECT (SELECT count(*) FROM waiting WHERE batch IS NULL), "
        "(SELECT coalesce(sum(c.queued), 0) FROM batches b JOIN batch_counts c ON c.batch = b.seq "
        "WHERE b.ended_at IS NULL AND b.state <> 'leaving'), "
        "(SELECT count(*) FROM waiting WHERE crashes > 1 AND " +
        kPauseOver + "), " + kClock + ", " + head + "0" + order + ", " + head + "1" + order +
        ", EXISTS (SELECT 1 FROM settings WHERE name = 'paused' AND value = '1')")[0];
    Counted counted;
    counted.depth.single = row[0].as<std::size_t>();
    counted.depth.entries = row[1].as<std::size_t>();
    counted.depth.suspects = row[2].as<std::size_t>();
    counted.clock = row[3].as<UnixMs>();
    counted.depth.next_single = moment(row[4]);
    counted.depth.next_entry = moment(row[5]);
    counted.depth.paused = row[6].as<bool>();
    return counted;
}

std::optional<BatchSummary> find_batch(Session& session, const std::string& id) {
    static const std::string sql =
        "SELECT " + kBatchColumns + kBatchTables + " WHERE b.id = $1 AND b.state <> 'leaving'" + kBatchGroups;
    const pqxx::result rows = session.run(sql, Values().text(id));
    if (rows.empty()) return std::nullopt;
    return read_batch(rows[0]);
}

std::optional<std::string> find_batch_of_key(Session& session, const std::string& owner, const std::string& key) {
    const pqxx::result rows =
        session.run("SELECT id FROM batches WHERE owner = $1 AND idempotency_key = $2", Values().text(owner).text(key));
    if (rows.empty()) return std::nullopt;
    return text_of(rows[0][0]);
}

BatchPage list_batches(Session& session, const std::optional<std::string>& owner, int limit,
                       std::optional<std::int64_t> before_seq) {
    Query inner("(SELECT * FROM batches WHERE state <> 'leaving'");
    if (owner) inner += " AND owner = " + inner.text(*owner);
    if (before_seq) inner += " AND seq < " + inner.number(*before_seq);
    inner += " ORDER BY seq DESC LIMIT " + inner.number(limit + 1) + ") b";
    BatchPage page;
    for (const pqxx::row& row : inner
                                    .around("SELECT " + kBatchColumns + " FROM ",
                                            " LEFT JOIN batch_counts c ON c.batch = b.seq GROUP BY b.seq, b.id, "
                                            "b.name, b.owner, b.created_at, b.state, b.cancel_requested, b.traceparent "
                                            "ORDER BY b.seq DESC")
                                    .run(session))
        page.batches.push_back(read_batch(row));
    page.more = page.batches.size() > static_cast<std::size_t>(limit);
    if (page.more) page.batches.pop_back();
    return page;
}

std::vector<BatchRow> find_rows(Session& session, const std::string& batch, std::int64_t from, std::size_t limit) {
    // The lengths of texts are known without reading them.
    static const std::string sql =
        "SELECT place, id, name, status, result, error FROM (SELECT p.*, "
        "sum(coalesce(octet_length(p.result), 0) + coalesce(octet_length(p.error), 0)) "
        "OVER (ORDER BY p.place ROWS BETWEEN UNBOUNDED PRECEDING AND 1 PRECEDING) AS before FROM ("
        "SELECT j.batch_index AS place, j.id, j.name, " +
        kStatus +
        " AS status, e.result, e.error FROM jobs j LEFT JOIN ended e ON e.seq = j.seq "
        "LEFT JOIN running r ON r.seq = j.seq WHERE j.batch = " +
        kBatchOfId +
        "$1) AND j.batch_index >= $2 ORDER BY j.batch_index LIMIT $3) p) b "
        "WHERE coalesce(before, 0) < $4 ORDER BY place";
    const Values values = std::move(Values()
                                        .text(batch)
                                        .number(from)
                                        .number(static_cast<std::int64_t>(limit))
                                        .number(static_cast<std::int64_t>(BatchStore::kRowsBytes)));
    std::vector<BatchRow> rows;
    for (const pqxx::row& row : session.run(sql, values))
        rows.push_back({row[0].as<std::int64_t>(), text_of(row[1]), text_of(row[2]), job_status(row[3].c_str()).value(),
                        text_of(row[4]), text_of(row[5])});
    return rows;
}

}  // namespace tunewright::server::postgres
