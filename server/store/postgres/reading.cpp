#include "server/store/postgres/reading.h"

#include <algorithm>

#include "server/store/postgres/text.h"

namespace tunewright::server::postgres {
namespace {

constexpr int kSummaryCount = 16;

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
    job.outline = text_of(row[14]);
}

}  // namespace

const std::string kSummaryColumns =
    "j.seq, j.id, j.name, j.status, j.created_at, j.started_at, j.finished_at, j.attempts, j.timeout_s, "
    "j.request_hash, j.cancel_requested, j.owner, b.id, j.batch_index, j.outline, "
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

namespace {

/// A SELECT that grows condition by condition, with the values of its parameters.
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
    static const std::string sql = "SELECT " + kRecordColumns + kTables + " WHERE j.id = $1 AND " + kVisible;
    const pqxx::result rows = session.run(sql, Values().text(id));
    if (rows.empty()) return std::nullopt;
    return read_record(rows[0]);
}

std::vector<JobState> find_states(Session& session, const std::vector<std::string>& ids) {
    static const std::string sql =
        "SELECT " + kSummaryColumns + kTables + " WHERE j.id = ANY ($1::text[]) AND " + kVisible;
    TextArray wanted;
    for (const std::string& id : ids) wanted.add(id);
    std::vector<JobState> states;
    for (const pqxx::row& row : session.run(sql, Values().plain(wanted.literal()))) states.push_back(read_state(row));
    return states;
}

JobPage list_jobs(Session& session, const JobQuery& query) {
    // The entries of a batch stand in the order of their index, which is that of their seq too.
    Query sql("SELECT " + kSummaryColumns + kTables);
    if (query.batch)
        sql += " WHERE j.batch = " + kBatchOfId + sql.text(*query.batch) + ")";
    else
        sql += " WHERE j.class = 0";
    if (query.status) sql += " AND j.status = " + sql.text(std::string(to_string(*query.status)));
    if (query.name) sql += " AND j.name = " + sql.text(*query.name);
    if (query.owner) sql += " AND j.owner = " + sql.text(*query.owner);
    if (query.text) {
        const std::string part = "lower(" + sql.text(*query.text) + "::text)";
        sql += " AND (strpos(lower(j.name), " + part + ") > 0 OR strpos(j.id, " + part +
               ") > 0 OR strpos(j.outline::jsonb ->> 'method', " + part + ") > 0)";
    }
    if (query.before_seq && query.batch)
        sql += " AND j.batch_index < (SELECT batch_index FROM jobs WHERE seq = " + sql.number(*query.before_seq) + ")";
    if (query.before_seq && !query.batch) sql += " AND j.seq < " + sql.number(*query.before_seq);
    sql += std::string(" ORDER BY ") + (query.batch ? "j.batch_index" : "j.seq") + " DESC LIMIT " +
           sql.number(query.limit + 1);
    JobPage page;
    for (const pqxx::row& row : sql.run(session)) page.jobs.push_back(read_summary(row));
    page.more = page.jobs.size() > static_cast<std::size_t>(query.limit);
    if (page.more) page.jobs.pop_back();
    return page;
}

Counted count_waiting(Session& session) {
    const pqxx::row row = session.run(
        "SELECT (SELECT count(*) FROM jobs WHERE status = 'queued' AND class = 0), "
        "(SELECT coalesce(sum(c.queued), 0) FROM batch_counts c JOIN batches b ON b.seq = c.batch "
        "WHERE b.state <> 'leaving'), "
        "(SELECT count(*) FROM jobs WHERE status = 'queued' AND crashes > 1 AND not_before <= clock_timestamp()), "
        "(extract(epoch FROM clock_timestamp()) * 1000)::bigint, "
        "(SELECT created_at FROM jobs WHERE status = 'queued' AND class = 0 ORDER BY class, turn, seq LIMIT 1), "
        "(SELECT created_at FROM jobs WHERE status = 'queued' AND class = 1 ORDER BY class, turn, seq LIMIT 1)")[0];
    const auto moment = [](const pqxx::field& field) {
        return field.is_null() ? std::nullopt : std::optional(field.as<UnixMs>());
    };
    return {
        {row[0].as<std::size_t>(), row[1].as<std::size_t>(), row[2].as<std::size_t>(), moment(row[4]), moment(row[5])},
        row[3].as<UnixMs>()};
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
                                            "b.name, b.owner, b.created_at, b.state, b.cancel_requested "
                                            "ORDER BY b.seq DESC")
                                    .run(session))
        page.batches.push_back(read_batch(row));
    page.more = page.batches.size() > static_cast<std::size_t>(limit);
    if (page.more) page.batches.pop_back();
    return page;
}

std::vector<BatchRow> find_rows(Session& session, const std::string& batch, std::int64_t from, std::size_t limit) {
    static const std::string sql =
        "SELECT batch_index, id, name, status, result, error FROM jobs WHERE batch = " + kBatchOfId +
        "$1) AND batch_index >= $2 ORDER BY batch_index LIMIT $3";
    std::vector<BatchRow> rows;
    for (const pqxx::row& row :
         session.run(sql, Values().text(batch).number(from).number(static_cast<std::int64_t>(limit))))
        rows.push_back({row[0].as<std::int64_t>(), text_of(row[1]), text_of(row[2]), job_status(row[3].c_str()).value(),
                        text_of(row[4]), text_of(row[5])});
    return rows;
}

}  // namespace tunewright::server::postgres
