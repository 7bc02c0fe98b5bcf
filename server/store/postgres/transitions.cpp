#include "server/store/postgres/transitions.h"

#include <algorithm>

#include "server/store/postgres/reading.h"
#include "server/store/postgres/text.h"

namespace tunewright::server::postgres {

std::optional<RunningRow> RunningRow::take(Session& session, std::int64_t seq, int attempts) {
    static const std::string sql =
        "DELETE FROM running r WHERE r.seq = $1 AND ($2 = 0 OR r.attempts = $2) RETURNING r.batch, r.attempts, "
        "r.crashes, r.cancel_requested OR EXISTS (SELECT 1 FROM batches b WHERE b.seq = r.batch AND "
        "b.cancel_requested), r.class, r.turn, r.flow, r.started_at";
    const pqxx::result rows = session.run(sql, Values().number(seq).number(attempts));
    if (rows.empty()) return std::nullopt;
    RunningRow taken;
    taken.run_.seq = seq;
    if (!rows[0][0].is_null()) taken.run_.batch = rows[0][0].as<std::int64_t>();
    taken.run_.attempts = rows[0][1].as<int>();
    taken.run_.crashes = rows[0][2].as<int>();
    taken.run_.unwanted = rows[0][3].as<bool>();
    taken.priority_ = rows[0][4].c_str();
    taken.turn_ = rows[0][5].c_str();
    taken.flow_ = rows[0][6].c_str();
    taken.started_at_ = rows[0][7].c_str();
    return taken;
}

void RunningRow::put_waiting(Session& session, int crashes) const {
    static const std::string sql =
        "INSERT INTO waiting (class, turn, seq, flow, batch, attempts, crashes, not_before) VALUES ($1, $2, $3, $4, "
        "nullif($5, 0::bigint), $6, $7, CASE WHEN $8 > 0 THEN clock_timestamp() + $8::bigint * interval "
        "'1 millisecond' END)";
    session.run(sql, Values()
                         .plain(priority_)
                         .plain(turn_)
                         .number(run_.seq)
                         .plain(flow_)
                         .number(run_.batch.value_or(0))
                         .number(run_.attempts)
                         .number(crashes)
                         .number(crashes > run_.crashes ? pause_after(crashes).count() : 0));
}

void RunningRow::put_ended(Session& session, JobStatus status, UnixMs at, const std::string& error) const {
    static const std::string sql =
        "WITH gone AS (INSERT INTO ended (seq, single, status, attempts, cancel_requested, started_at, finished_at, "
        "error) VALUES ($1, $2 = 0, $3, $4, $5, $6, $7, nullif($8, '')) RETURNING seq) " +
        insert_deliveries("gone", "$7");
    session.run(sql, Values()
                         .number(run_.seq)
                         .number(run_.batch.value_or(0))
                         .plain(std::string(to_string(status)))
                         .number(run_.attempts)
                         .plain(run_.unwanted ? "t" : "f")
                         .plain(started_at_)
                         .number(at)
                         .text(error));
}

std::string insert_deliveries(const std::string& source, const std::string& at) {
    return "INSERT INTO deliveries (target, job, created_at, due_at) SELECT j.notify, j.id, " + at + "::bigint, " + at +
           "::bigint FROM " + source + " s JOIN jobs j ON j.seq = s.seq WHERE j.notify IS NOT NULL AND j.batch IS NULL";
}

void BatchCounts::move(const std::optional<std::int64_t>& batch, std::optional<JobStatus> from,
                       std::optional<JobStatus> to, std::int64_t count, UnixMs ended_at) {
    if (!batch || count == 0) return;
    Change& change = changes_[*batch];
    if (from) change.by_status[static_cast<std::size_t>(*from)] -= count;
    if (to) change.by_status[static_cast<std::size_t>(*to)] += count;
    change.last_end = std::max(change.last_end, ended_at);
}

void BatchCounts::write(Session& session) const {
    if (changes_.empty()) return;
    static const std::string sql =
        "INSERT INTO batch_counts AS c (batch, slot, queued, running, succeeded, failed, cancelled, last_end) "
        "SELECT g.batch, pg_backend_pid() % 64, g.queued, g.running, g.succeeded, g.failed, g.cancelled, g.last_end "
        "FROM unnest($1::bigint[], $2::bigint[], $3::bigint[], $4::bigint[], $5::bigint[], $6::bigint[], $7::bigint[]) "
        "AS g (batch, queued, running, succeeded, failed, cancelled, last_end) "
        "WHERE EXISTS (SELECT 1 FROM batches b WHERE b.seq = g.batch) "
        "ON CONFLICT (batch, slot) DO UPDATE SET queued = c.queued + EXCLUDED.queued, "
        "running = c.running + EXCLUDED.running, succeeded = c.succeeded + EXCLUDED.succeeded, "
        "failed = c.failed + EXCLUDED.failed, cancelled = c.cancelled + EXCLUDED.cancelled, "
        "last_end = greatest(c.last_end, EXCLUDED.last_end)";
    TextArray batch, counts[5], last_end;
    for (const auto& [seq, change] : changes_) {
        batch.add_plain(std::to_string(seq));
        for (std::size_t i = 0; i < 5; i++) counts[i].add_plain(std::to_string(change.by_status[i]));
        last_end.add_plain(std::to_string(change.last_end));
    }
    Values values;
    values.plain(batch.literal());
    for (const TextArray& array : counts) values.plain(array.literal());
    session.run(sql, values.plain(last_end.literal()));
}

std::string under_way(const std::string& flow) {
    const std::string mine = "c.flow = " + flow, single = mine + " AND c.batch IS NULL)";
    return "((SELECT count(*) FROM waiting c WHERE c.class = 0 AND " + mine +
           ") + (SELECT count(*) FROM waiting c WHERE c.class > 0 AND " + single +
           " + (SELECT count(*) FROM running c WHERE " + single + ")";
}

const std::string kClock = "(extract(epoch FROM clock_timestamp()) * 1000)::bigint";

std::string last_turn(const std::string& priority, const std::string& flow) {
    const std::string waiting = " FROM waiting w WHERE w.class = " + priority + " AND w.";
    return "greatest(0, (SELECT w.turn - 1" + waiting + "crashes < 2 ORDER BY w.class, w.turn, w.seq LIMIT 1), " +
           "(SELECT max(w.turn)" + waiting + "flow = " + flow + "))";
}

}  // namespace tunewright::server::postgres
