// Claims, signs of life, and what becomes of the jobs of a worker that gives none.
#include "server/store/sqlite/changes.h"
#include "server/store/sqlite/moves.h"
#include "server/store/sqlite/reading.h"

namespace tunewright::server {
namespace {

constexpr const char* kNext = "SELECT seq, class, turn, flow, batch, attempts, crashes FROM waiting WHERE ";

std::vector<Place> read_places(Connection::Use& row) {
    std::vector<Place> places;
    while (row.next()) places.push_back(read_place(row));
    return places;
}

std::vector<Place> next_places(Connection& store, const Claim& claim) {
    static const std::string usual =
        std::string(kNext) + "class < 2 AND crashes < 2 ORDER BY class, turn, seq LIMIT ?1";
    static const std::string low = std::string(kNext) + "crashes < 2 AND class = 1 ORDER BY turn, seq LIMIT ?1";
    static const std::string suspects =
        std::string(kNext) + "crashes > 1 AND " + pause_over("?2") + " ORDER BY not_before LIMIT ?1";
    const auto most = static_cast<std::int64_t>(claim.most);
    if (claim.suspects) {
        Connection::Use row = store.use(suspects);
        return read_places(row.with(most, claim.now));
    }
    if (claim.low_first) {
        Connection::Use row = store.use(low);
        if (std::vector<Place> places = read_places(row.with(most)); !places.empty()) return places;
    }
    Connection::Use row = store.use(usual);
    return read_places(row.with(most));
}

void hear_of(Connection& store, const std::string& worker, UnixMs lease_until) {
    store
        .use(
            "INSERT INTO workers (name, lease_until) VALUES (?1, ?2) ON CONFLICT (name) DO UPDATE "
            "SET lease_until = ?2 WHERE lease_until < ?2")
        .with(worker, lease_until)
        .run();
}

/// Where an end was asked for, of the job or of its batch, it comes now instead of another attempt.
bool is_unwanted(Connection& store, const Run& run) {
    if (run.cancel_requested) return true;
    if (!run.batch) return false;
    Connection::Use row = store.use("SELECT cancel_requested FROM batches WHERE seq = ?1");
    return row.with(*run.batch).next() && row.integer(0) != 0;
}

std::string id_of(Connection& store, std::int64_t seq) {
    Connection::Use row = store.use("SELECT id FROM jobs WHERE seq = ?1");
    return row.with(seq).next() ? row.text(0) : std::string{};
}

std::vector<std::int64_t> abandoned(Connection& store, UnixMs lease_at) {
    Connection::Use row = store.use(
        "SELECT r.seq FROM running r LEFT JOIN workers w ON w.name = r.worker "
        "WHERE coalesce(w.lease_until, 0) <= ?1");
    row.with(lease_at);
    std::vector<std::int64_t> found;
    while (row.next()) found.push_back(row.integer(0));
    return found;
}

}  // namespace

std::vector<JobRecord> claim_jobs(Connection& store, const Claim& claim) {
    if (is_paused(store)) return {};
    std::vector<JobRecord> claimed;
    BatchCounts counts;
    for (Place& place : next_places(store, claim)) {
        take_waiting(store, place);
        place.attempts++;
        put_running(store, place, claim.worker, claim.now);
        counts.move(place.batch, JobStatus::queued, JobStatus::running);
        claimed.push_back(read_claimed(store, place.seq));
        claimed.back().attempts = place.attempts;
        claimed.back().started_at = claim.now;
    }
    counts.write(store);
    if (!claimed.empty()) hear_of(store, claim.worker, claim.now + claim.lease.count());
    return claimed;
}

bool any_due(Connection& store, UnixMs now) {
    Connection::Use row = store.use("SELECT 1 FROM waiting WHERE class = 2 AND turn <= ?1 LIMIT 1");
    return row.with(now).next();
}

std::size_t start_due(Connection& store, UnixMs now) {
    std::vector<Place> due;
    {
        Connection::Use row = store.use(
            "SELECT w.seq, j.class, w.turn, w.flow, w.batch, w.attempts, w.crashes FROM waiting w "
            "JOIN jobs j ON j.seq = w.seq WHERE w.class = 2 AND w.turn <= ?1 ORDER BY w.turn, w.seq LIMIT 1000");
        due = read_places(row.with(now));
    }
    for (const Place& job : due) {
        const std::int64_t turn = next_turn(store, job.priority, job.flow);
        store.use("UPDATE waiting SET class = ?3, turn = ?4 WHERE class = 2 AND turn = ?2 AND seq = ?1")
            .with(job.seq, job.turn, job.priority, turn)
            .run();
        store.use("UPDATE jobs SET turn = ?2 WHERE seq = ?1").with(job.seq, turn).run();
    }
    return due.size();
}

std::vector<Holding> beat_worker(Connection& store, const Heartbeat& beat) {
    hear_of(store, beat.worker, beat.now + beat.lease.count());
    for (const ProgressNote& note : beat.progress)
        store.use("UPDATE running SET progress = ?3 WHERE seq = ?1 AND attempts = ?2 AND worker = ?4")
            .with(note.seq, note.attempts, note.progress, beat.worker)
            .run();
    Connection::Use row =
        store.use("SELECT seq, attempts, cancel_requested, started_at FROM running WHERE worker = ?1");
    row.with(beat.worker);
    std::vector<Holding> held;
    while (row.next())
        held.push_back({row.integer(0), static_cast<int>(row.integer(1)), row.integer(2) != 0, row.integer(3)});
    return held;
}

bool release_job(Connection& store, std::int64_t seq, int attempts, UnixMs now) {
    const std::optional<Run> run = take_running(store, seq, attempts);
    if (!run) return false;
    const bool unwanted = is_unwanted(store, *run);
    unwanted ? put_ended(store, *run, run->started_at, Ending::cancelled(now)) : put_waiting(store, *run);
    BatchCounts counts;
    counts.move(run->batch, JobStatus::running, unwanted ? JobStatus::cancelled : JobStatus::queued,
                unwanted ? now : 0);
    counts.write(store);
    return true;
}

Recovery reclaim_jobs(Connection& store, UnixMs lease_at, const Reclaim& what) {
    Recovery recovery;
    BatchCounts counts;
    for (const std::int64_t seq : abandoned(store, lease_at)) {
        Run run = take_running(store, seq, std::nullopt).value();
        const bool unwanted = is_unwanted(store, run);
        run.crashes++;
        if (!unwanted && run.crashes < what.most_attempts) {
            std::optional<UnixMs> not_before;
            if (run.crashes > 1) not_before = what.now + pause_after(run.crashes).count();
            put_waiting(store, run, not_before);
            counts.move(run.batch, JobStatus::running, JobStatus::queued);
            recovery.interrupted++;
            continue;
        }
        const Ending ending = unwanted ? Ending::cancelled(what.now) : Ending::failed(what.now, what.error);
        put_ended(store, run, run.started_at, ending);
        counts.move(run.batch, JobStatus::running, ending.status, what.now);
        recovery.given_up += unwanted ? 0U : 1U;
        recovery.ended.push_back(id_of(store, seq));
    }
    counts.write(store);
    store.use("DELETE FROM workers WHERE lease_until <= ?1").with(lease_at).run();
    return recovery;
}

}  // namespace tunewright::server
