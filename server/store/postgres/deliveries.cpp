// Notes to whoever wants to hear of an end, and the settings that all processes share.
#include "server/store/postgres/changes.h"
#include "server/store/postgres/reading.h"

namespace tunewright::server::postgres {

std::vector<Delivery> take_deliveries(Session& session, UnixMs now, std::chrono::milliseconds hold, std::size_t most) {
    const pqxx::result rows = session.run(
        "WITH due AS MATERIALIZED (SELECT seq, due_at FROM deliveries WHERE due_at <= $1 ORDER BY due_at LIMIT $3 "
        "FOR UPDATE SKIP LOCKED), held AS (UPDATE deliveries d SET due_at = $2 FROM due WHERE d.seq = due.seq "
        "RETURNING d.seq, d.target, d.job, d.batch, d.tries, d.created_at, due.due_at AS was) "
        "SELECT seq, target, job, batch, tries, created_at FROM held ORDER BY was, seq",
        Values().number(now).number(now + hold.count()).number(static_cast<std::int64_t>(most)));
    std::vector<Delivery> due;
    for (const pqxx::row& row : rows)
        due.push_back({row[0].as<std::int64_t>(), NotifyTarget::of_text(text_of(row[1])), text_of(row[2]),
                       text_of(row[3]), row[4].as<int>(), row[5].as<UnixMs>()});
    return due;
}

bool settle_delivery(Session& session, std::int64_t seq, UnixMs now, std::optional<std::chrono::milliseconds> pause,
                     bool tried) {
    if (!pause) return session.run("DELETE FROM deliveries WHERE seq = $1", Values().number(seq)).affected_rows() > 0;
    return session
               .run("UPDATE deliveries SET tries = tries + $3, due_at = $2 WHERE seq = $1",
                    Values().number(seq).number(now + pause->count()).number(tried ? 1 : 0))
               .affected_rows() > 0;
}

bool pause_queue(Session& session, bool paused) {
    session.run("INSERT INTO settings (name, value) VALUES ('paused', $1) ON CONFLICT (name) DO UPDATE SET value = $1",
                Values().plain(paused ? "1" : "0"));
    return true;
}

}  // namespace tunewright::server::postgres
