// Notes to whoever wants to hear of an end, and the settings that last.
#include "server/store/sqlite/changes.h"

namespace tunewright::server {

std::vector<Delivery> take_deliveries(Connection& store, UnixMs now, std::chrono::milliseconds hold, std::size_t most) {
    std::vector<Delivery> due;
    {
        Connection::Use row = store.use(
            "SELECT seq, target, job, batch, tries, created_at FROM deliveries WHERE due_at <= ?1 "
            "ORDER BY due_at LIMIT ?2");
        row.with(now, static_cast<std::int64_t>(most));
        while (row.next())
            due.push_back({row.integer(0), NotifyTarget::of_text(row.text(1)), row.text(2), row.text(3),
                           static_cast<int>(row.integer(4)), row.integer(5)});
    }
    for (const Delivery& delivery : due)
        store.use("UPDATE deliveries SET due_at = ?2 WHERE seq = ?1").with(delivery.seq, now + hold.count()).run();
    return due;
}

bool settle_delivery(Connection& store, std::int64_t seq, UnixMs now, std::optional<std::chrono::milliseconds> pause,
                     bool tried) {
    if (!pause) return store.use("DELETE FROM deliveries WHERE seq = ?1").with(seq).run() > 0;
    return store.use("UPDATE deliveries SET tries = tries + ?3, due_at = ?2 WHERE seq = ?1")
               .with(seq, now + pause->count(), tried ? 1 : 0)
               .run() > 0;
}

bool pause_queue(Connection& store, bool paused) {
    store.use("INSERT OR REPLACE INTO settings (name, value) VALUES ('paused', ?1)").with(paused ? "1" : "0").run();
    return true;
}

bool is_paused(Connection& store) {
    return store.number("SELECT count(*) FROM settings WHERE name = 'paused' AND value = '1'") > 0;
}

}  // namespace tunewright::server
