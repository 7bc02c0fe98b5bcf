#include "server/store/sqlite/sqlite_store.h"

#include <cerrno>
#include <filesystem>
#include <future>
#include <limits>
#include <ostream>
#include <type_traits>

#include "server/clock.h"
#include "server/store/pool.h"
#include "server/store/sqlite/batch_changes.h"
#include "server/store/sqlite/file.h"
#include "server/store/sqlite/job_changes.h"
#include "server/store/sqlite/reading.h"
#include "server/store/sqlite/reserve.h"
#include "server/store/sqlite/schema.h"
#include "server/store/sqlite/writer.h"

namespace tunewright::server {
namespace {

constexpr UnixMs kEndOfTime = std::numeric_limits<UnixMs>::max();
constexpr std::size_t kOpeningBytes = 256 << 10;                  // bytes that opening may write
constexpr std::size_t kReaders = 8;                               // connections for reading
constexpr const char* kPageCache = "PRAGMA cache_size = -16384";  // KiB; the default of 2 MiB thrashes in long queues

/// The file is locked.
Connection open_file(const std::string& path) {
    refuse_foreign_log(path);
    return {path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE};
}

void bring_up_to_date(SQLite::Database& database, SchemaSteps steps) {
    const SchemaState state = schema_state(database);
    if (steps == SchemaSteps::leave && state.have != 0 && state.have < state.known) throw SchemaBehind(state);
    migrate(database);
}

class SqliteStore : public JobStore {
public:
    SqliteStore(const std::string& path, SchemaSteps steps)
        : path_(path), lock_(path), reserve_(path), connection_(open_file(path)) {
        connection_.database().exec("PRAGMA journal_mode = WAL");
        // Debian's library overwrites each freed page with zeros, which is most of the cost of deleting.
        connection_.database().exec("PRAGMA secure_delete = FAST");
        connection_.database().exec(kPageCache);
        bring_up_to_date(connection_.database(), steps);
        connection_.database().tryExec("PRAGMA wal_checkpoint(TRUNCATE)");
        reserve_.fill();
        writer_ = std::make_unique<SqliteWriter>(connection_, reserve_);
    }

    ~SqliteStore() override {
        if (writer_) writer_->stop();
    }

    bool shared() const override { return false; }
    void watch(std::function<void(const StoreNotice&)>) override {}
    bool healthy() const override { return writer_->healthy(); }

    Recovery recover(UnixMs now, int attempts, const std::string& error) override;
    void reclaim(Reclaim what, Done<Recovery> done) override;

    std::optional<JobRecord> find(const std::string& id) override {
        return read([&](Connection& store) { return find_record(store, id); });
    }
    std::vector<JobState> states(const std::vector<std::string>& ids) override {
        return read([&](Connection& store) { return find_states(store, ids); });
    }
    std::optional<JobState> job_of_key(const std::string& owner, const std::string& idempotency_key) override {
        return read([&](Connection& store) { return find_job_of_key(store, owner, idempotency_key); });
    }
    JobPage list(const JobQuery& query) override {
        return read([&](Connection& store) { return list_jobs(store, query); });
    }
    QueueDepth depth() override { return read(count_waiting); }

    void accept(NewJob job, Done<Accepted> done) override {
        const std::size_t bytes = job.request.size();
        write<Accepted>(
            kDurable, [this, job = std::move(job)](Connection& store) { return accept_job(store, bounds_, job); },
            std::move(done), bytes, Kind::job);
    }
    void claim(Claim claim, Done<std::vector<JobRecord>> done) override {
        // Without waiting for the disk: after a power failure the job is queued again, as it should be.
        write<std::vector<JobRecord>>(
            kQuick, [claim = std::move(claim)](Connection& store) { return claim_jobs(store, claim); },
            std::move(done));
    }
    void beat(Heartbeat beat, Done<std::vector<Holding>> done) override {
        write<std::vector<Holding>>(
            kQuick, [beat = std::move(beat)](Connection& store) { return beat_worker(store, beat); }, std::move(done));
    }
    void finish(JobEnd end, Done<bool> done) override {
        const std::size_t bytes = end.result.size() + end.error.size();
        write<bool>(
            end.first ? kDurable : kGathered,
            [end = std::move(end)](Connection& store) { return finish_job(store, end); }, std::move(done), bytes);
    }
    void release(std::int64_t seq, int attempts, Done<bool> done) override {
        write<bool>(
            kDurable, [=](Connection& store) { return release_job(store, seq, attempts, wall_clock()); },
            std::move(done));
    }
    void cancel(std::string id, UnixMs now, Done<CancelEffect> done) override {
        write<CancelEffect>(
            kDurable, [id = std::move(id), now](Connection& store) { return cancel_job(store, id, now); },
            std::move(done));
    }
    void start_due(UnixMs now, Done<std::size_t> done) override {
        if (!read([&](Connection& store) { return any_due(store, now); })) return done(std::size_t{0});
        write<std::size_t>(
            kQuick, [now](Connection& store) { return server::start_due(store, now); }, std::move(done));
    }
    void requeue(std::string id, Done<RequeueEffect> done) override {
        write<RequeueEffect>(
            kDurable,
            [this, id = std::move(id)](Connection& store) {
                bounds_.clear();
                return requeue_job(store, id);
            },
            std::move(done));
    }
    void pause(bool paused, Done<bool> done) override {
        write<bool>(
            kDurable, [paused](Connection& store) { return pause_queue(store, paused); }, std::move(done));
    }
    void remove(std::string id, Done<RemoveEffect> done) override {
        write<RemoveEffect>(
            kDurable, [id = std::move(id)](Connection& store) { return remove_job(store, id); }, std::move(done), 0,
            Kind::gives_room);
    }

    void open_batch(NewBatch batch, Done<bool> done) override {
        write<bool>(
            kBulky,
            [batch = std::move(batch)](Connection& store) {
                server::open_batch(store, batch);
                return true;
            },
            std::move(done), 0, Kind::job);
    }
    void add_entries(std::string batch, std::vector<NewEntry> entries, UnixMs now, Done<bool> done) override {
        std::size_t bytes = 0;
        for (const NewEntry& entry : entries) bytes += entry.request.size() + entry.error.size();
        write<bool>(
            kBulky,
            [batch = std::move(batch), entries = std::move(entries), now](Connection& store) {
                return server::add_entries(store, batch, entries, now);
            },
            std::move(done), bytes, Kind::job);
    }
    void seal_batch(BatchSeal seal, Done<Sealed> done) override { slices_.seal(std::move(seal), std::move(done)); }
    void drop_batch(std::string batch, Done<bool> done) override { slices_.drop(std::move(batch), std::move(done)); }
    void cancel_batch(std::string id, UnixMs now, Done<std::optional<std::vector<std::string>>> done) override {
        slices_.cancel(std::move(id), now, std::move(done));
    }
    void remove_batch(std::string id, Done<RemoveEffect> done) override {
        slices_.remove(std::move(id), std::move(done));
    }
    void sweep(UnixMs now, Retention retention, std::size_t max, Done<std::size_t> done) override {
        slices_.sweep(now, retention, max, std::move(done));
    }

    void take_deliveries(UnixMs now, std::chrono::milliseconds hold, std::size_t max,
                         Done<std::vector<Delivery>> done) override {
        write<std::vector<Delivery>>(
            kQuick, [=](Connection& store) { return server::take_deliveries(store, now, hold, max); }, std::move(done));
    }
    void settle_delivery(std::int64_t seq, UnixMs now, std::optional<std::chrono::milliseconds> pause, bool tried,
                         Done<bool> done) override {
        write<bool>(
            kQuick, [=](Connection& store) { return server::settle_delivery(store, seq, now, pause, tried); },
            std::move(done));
    }

    std::optional<BatchSummary> find_batch(const std::string& id) override {
        return read([&](Connection& store) { return server::find_batch(store, id); });
    }
    std::optional<std::string> batch_of_key(const std::string& owner, const std::string& idempotency_key) override {
        return read([&](Connection& store) { return find_batch_of_key(store, owner, idempotency_key); });
    }
    BatchPage list_batches(const std::optional<std::string>& owner, int limit,
                           std::optional<std::int64_t> before_seq) override {
        return read([&](Connection& store) { return server::list_batches(store, owner, limit, before_seq); });
    }
    std::vector<BatchRow> batch_rows(const std::string& id, std::int64_t from, std::size_t limit) override {
        return read([&](Connection& store) { return find_rows(store, id, from, limit); });
    }

private:
    /// kGathered is a kDurable change that nobody waits for. kIdle is a kBulky change that does not wait for the disk:
    /// after a power failure it is made again.
    enum Manner { kDurable, kGathered, kQuick, kBulky, kIdle };
    using Kind = SqliteWriter::Change::Kind;

    /// Queues `work`, which stores texts of this length, for the writer and passes its value on after the commit.
    template <class T, class Work>
    void write(Manner manner, Work work, Done<T> done, std::size_t bytes = 0, Kind kind = Kind::usual) {
        auto value = std::make_shared<T>();
        SqliteWriter::Change change;
        change.apply = [value, work = std::move(work)](Connection& store) { *value = work(store); };
        change.done = [value, done = std::move(done)](const std::optional<StoreFault>& fault) {
            fault ? done(*fault) : done(std::move(*value));
        };
        change.durable = manner == kDurable || manner == kGathered || manner == kBulky;
        change.patient = manner == kGathered;
        change.bulky = manner == kBulky || manner == kIdle;
        change.bytes = bytes;
        change.kind = kind;
        writer_->submit(std::move(change));
    }

    /// Waits for a change; allowed only while no callback of the writer waits for this thread.
    template <class T, class Work>
    T write_now(Work work) {
        std::promise<Outcome<T>> promise;
        write<T>(
            kBulky, std::move(work), [&](Outcome<T> outcome) { promise.set_value(std::move(outcome)); }, 0,
            Kind::gives_room);
        Outcome<T> outcome = promise.get_future().get();
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) throw StoreError(*fault);
        return std::get<T>(std::move(outcome));
    }

    template <class Work>
    std::invoke_result_t<Work, Connection&> read(Work work) {
        try {
            Pool<Connection>::Slot place(readers_);
            std::unique_ptr<Connection> reader = place.connection();
            if (!reader) reader = std::make_unique<Connection>(path_, SQLite::OPEN_READONLY);
            auto found = work(*reader);
            place.keep(std::move(reader));
            return found;
        } catch (const SQLite::Exception& error) {
            throw StoreError(fault_of(error));
        }
    }

    std::string path_;
    FileLock lock_;
    Reserve reserve_;
    Connection connection_;
    ClientBounds bounds_;  ///< used by the writer's thread
    Pool<Connection> readers_{kReaders};
    std::unique_ptr<SqliteWriter> writer_;
    Slices<Connection> slices_{[this](std::function<void(Connection&)> apply, Slices<Connection>::Finished done) {
        writer_->submit({std::move(apply), std::move(done), true, true, false, 0, Kind::gives_room});
    }};
};

Recovery SqliteStore::recover(UnixMs now, int attempts, const std::string& error) {
    // Interrupted changes are finished first, slice by slice, so that their entries do not count as waiting jobs.
    const auto unsettled = write_now<Unsettled>([](Connection& store) { return settle_batches(store, kEndOfTime); });
    for (const std::int64_t batch : unsettled.leaving)
        while (write_now<std::size_t>([&](Connection& store) { return delete_entries(store, batch, kSliceEntries); }) >
               0) {
        }
    using Next = std::optional<std::int64_t>;
    for (const std::int64_t batch : unsettled.cancelling)
        for (Next next = 0; next;)
            next = write_now<Next>([&](Connection& store) { return cancel_entries(store, batch, *next, now); });
    const Reclaim what{now, attempts, error};
    return write_now<Recovery>([&](Connection& store) { return reclaim_jobs(store, kEndOfTime, what); });
}

void SqliteStore::reclaim(Reclaim what, Done<Recovery> done) {
    using Reclaimed = std::pair<Recovery, Unsettled>;
    const UnixMs now = what.now;
    write<Reclaimed>(
        kBulky,
        [what = std::move(what)](Connection& store) {
            Reclaimed found;
            if (what.leases) found.first = reclaim_jobs(store, what.now, what);
            found.second = settle_batches(store, what.now - kReceiving.count());
            return found;
        },
        [this, now, done = std::move(done)](Outcome<Reclaimed> outcome) {
            if (const auto* fault = std::get_if<StoreFault>(&outcome)) return done(*fault);
            auto& [recovery, unsettled] = std::get<Reclaimed>(outcome);
            slices_.go_on(unsettled, now);
            done(std::move(recovery));
        });
}

/// Runs `work`, which opens the file; on a full disk once more with the space of the reserve.
template <class Work>
auto opening_where_room(const std::string& path, Work work) {
    return opening(path, [&] {
        make_folder(path);
        for (;;) {
            errno = 0;
            try {
                return work();
            } catch (const SQLite::Exception& error) {
                // There may be no space for the files next to it, which SQLite reports in many ways.
                StoreFault fault = fault_of(error, errno);
                if (room_of(path).left < kOpeningBytes) fault.kind = StoreFault::Kind::full;
                if (fault.kind != StoreFault::Kind::full || !Reserve(path).release()) throw StoreError(fault);
            }
        }
    });
}

}  // namespace

std::unique_ptr<JobStore> open_sqlite_store(const std::string& path, SchemaSteps steps) {
    return opening_where_room(path, [&] { return std::make_unique<SqliteStore>(path, steps); });
}

void migrate_sqlite(const std::string& path, bool compact, std::ostream& out) {
    std::optional<int> had;
    opening_where_room(path, [&] {
        const FileLock lock(path);
        Connection connection = open_file(path);
        connection.database().exec("PRAGMA journal_mode = WAL");
        const SchemaState state = schema_state(connection.database());
        migrate(connection.database());
        if (!had) out << "The schema is at step " << state.known << "; it was at " << state.have << ".\n";
        had = state.have;
        if (!compact) return;
        const auto before = std::filesystem::file_size(path);
        connection.database().exec("VACUUM");
        connection.database().exec("PRAGMA wal_checkpoint(TRUNCATE)");
        out << "The file has " << std::filesystem::file_size(path) << " bytes; it had " << before << ".\n";
    });
}

}  // namespace tunewright::server
