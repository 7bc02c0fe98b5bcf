#include "server/store/postgres/postgres_store.h"

#include <atomic>
#include <future>
#include <ostream>

#include "server/clock.h"
#include "server/random.h"
#include "server/store/postgres/batch_changes.h"
#include "server/store/postgres/job_changes.h"
#include "server/store/postgres/listener.h"
#include "server/store/postgres/readers.h"
#include "server/store/postgres/reading.h"
#include "server/store/postgres/schema.h"
#include "server/store/postgres/writer.h"

namespace tunewright::server {
namespace postgres {
namespace {

/// Time limit for operations that are normally quick.
constexpr std::chrono::seconds kMaxSilence{5};

class PostgresStore : public JobStore {
public:
    PostgresStore(const Address& address, const std::string& tag)
        : readers_(address, watch_),
          listener_(address.pooled() ? nullptr : std::make_unique<Listener>(address, tag)),
          writer_(address, address.pooled() ? "" : tag, watch_),
          results_(address, address.pooled() ? "" : tag, watch_),
          bulk_(address, address.pooled() ? "" : tag, watch_) {
        PostgresStore::depth();  // its clock is known from the start
    }

    bool shared() const override { return true; }
    void watch(std::function<void(const StoreNotice&)> notify) override {
        if (listener_) listener_->watch(std::move(notify));
    }
    bool healthy() const override {
        return writer_.healthy() && results_.healthy() && bulk_.healthy() && writer_.silence() < kMaxSilence;
    }

    Recovery recover(UnixMs now, int attempts, const std::string& error) override {
        std::promise<Outcome<Recovery>> promise;
        reclaim({now, attempts, error}, [&](Outcome<Recovery> outcome) { promise.set_value(std::move(outcome)); });
        Outcome<Recovery> outcome = promise.get_future().get();
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) throw StoreError(*fault);
        return std::get<Recovery>(std::move(outcome));
    }
    void reclaim(Reclaim what, Done<Recovery> done) override;

    std::optional<JobRecord> find(const std::string& id) override {
        return readers_.read([&](Session& session) { return find_record(session, id); });
    }
    std::optional<JobState> job_of_key(const std::string& owner, const std::string& idempotency_key) override {
        return readers_.read([&](Session& session) { return find_job_of_key(session, owner, idempotency_key); });
    }
    std::vector<JobState> states(const std::vector<std::string>& ids) override {
        if (ids.empty()) return {};
        return readers_.read([&](Session& session) { return find_states(session, ids); });
    }
    JobPage list(const JobQuery& query) override {
        return readers_.read([&](Session& session) { return list_jobs(session, query); });
    }
    QueueDepth depth() override {
        return readers_.read([this](Session& session) {
            const UnixMs before = wall_clock();
            const Counted counted = count_waiting(session);
            ahead_ = counted.clock - (before + wall_clock()) / 2;
            return counted.depth;
        });
    }
    std::chrono::milliseconds clock_ahead() const override { return std::chrono::milliseconds(ahead_); }

    void accept(NewJob job, Done<Accepted> done) override { writer_.accept({std::move(job), std::move(done)}); }
    void claim(Claim claim, Done<std::vector<JobRecord>> done) override {
        writer_.claim({std::move(claim), std::move(done)});
    }
    void beat(Heartbeat beat, Done<std::vector<Holding>> done) override {
        writer_.beat({std::move(beat), std::move(done)});
    }
    void finish(JobEnd end, Done<bool> done) override { results_.finish({std::move(end), std::move(done)}); }
    void release(std::int64_t seq, int attempts, Done<bool> done) override {
        write<bool>(
            kQuick,
            [this, seq, attempts](Work& work) {
                const auto released = release_job(work.session, seq, attempts, wall_clock() + ahead_);
                if (!released) return false;
                released->status == JobStatus::queued ? work.notices.queued() : work.notices.ended(released->id);
                return true;
            },
            std::move(done));
    }
    void cancel(std::string id, UnixMs now, Done<CancelEffect> done) override {
        write<CancelEffect>(
            kQuick,
            [id = std::move(id), now](Work& work) {
                const CancelEffect effect = cancel_job(work.session, id, now);
                if (effect == CancelEffect::cancelled) work.notices.ended(id);
                if (effect == CancelEffect::requested) work.notices.cancel(id);
                return effect;
            },
            std::move(done));
    }
    void start_due(UnixMs, Done<std::size_t> done) override {
        if (!readers_.read(any_due)) return done(std::size_t{0});
        write<std::size_t>(
            kQuick,
            [](Work& work) {
                const std::size_t due = postgres::start_due(work.session);
                if (due > 0) work.notices.queued();
                return due;
            },
            std::move(done));
    }
    void requeue(std::string id, Done<RequeueEffect> done) override {
        write<RequeueEffect>(
            kQuick,
            [id](Work& work) {
                const RequeueEffect effect = requeue_job(work.session, id);
                if (effect == RequeueEffect::requeued) work.notices.queued();
                return effect;
            },
            std::move(done), id);
    }
    void pause(bool paused, Done<bool> done) override {
        write<bool>(
            kQuick,
            [paused](Work& work) {
                if (!paused) work.notices.queued();
                return pause_queue(work.session, paused);
            },
            std::move(done));
    }
    void remove(std::string id, Done<RemoveEffect> done) override {
        write<RemoveEffect>(
            kQuick, [id = std::move(id)](Work& work) { return remove_job(work.session, id); }, std::move(done));
    }

    void open_batch(NewBatch batch, Done<bool> done) override {
        write<bool>(
            kBulky,
            [batch = std::move(batch)](Work& work) {
                postgres::open_batch(work.session, batch);
                return true;
            },
            std::move(done));
    }
    void add_entries(std::string batch, std::vector<NewEntry> entries, UnixMs now, Done<bool> done) override {
        write<bool>(
            kBulky,
            [batch = std::move(batch), entries = std::move(entries), now](Work& work) {
                const bool added = postgres::add_entries(work.session, batch, entries, now);
                if (added && !entries.empty()) work.notices.queued();
                return added;
            },
            std::move(done));
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
            kQuick, [=](Work& work) { return postgres::take_deliveries(work.session, now, hold, max); },
            std::move(done));
    }
    void settle_delivery(std::int64_t seq, UnixMs now, std::optional<std::chrono::milliseconds> pause, bool tried,
                         Done<bool> done) override {
        write<bool>(
            kQuick, [=](Work& work) { return postgres::settle_delivery(work.session, seq, now, pause, tried); },
            std::move(done));
    }

    std::optional<BatchSummary> find_batch(const std::string& id) override {
        return readers_.read([&](Session& session) { return postgres::find_batch(session, id); });
    }
    std::optional<std::string> batch_of_key(const std::string& owner, const std::string& idempotency_key) override {
        return readers_.read([&](Session& session) { return find_batch_of_key(session, owner, idempotency_key); });
    }
    BatchPage list_batches(const std::optional<std::string>& owner, int limit,
                           std::optional<std::int64_t> before_seq) override {
        return readers_.read(
            [&](Session& session) { return postgres::list_batches(session, owner, limit, before_seq); });
    }
    std::vector<BatchRow> batch_rows(const std::string& id, std::int64_t from, std::size_t limit) override {
        return readers_.read([&](Session& session) { return find_rows(session, id, from, limit); });
    }

private:
    enum Manner { kQuick, kBulky };

    /// Queues `apply` for the writer and passes its value on after the commit. `requeued`: OtherChange's.
    template <class T, class Apply>
    void write(Manner manner, Apply apply, Done<T> done, std::string requeued = {}) {
        auto value = std::make_shared<T>();
        OtherChange change;
        change.apply = [value, apply = std::move(apply)](Work& work) { *value = apply(work); };
        change.done = [value, done = std::move(done)](const std::optional<StoreFault>& fault) {
            fault ? done(*fault) : done(std::move(*value));
        };
        change.requeued = std::move(requeued);
        (manner == kBulky ? bulk_ : writer_).change(std::move(change));
    }

    Watch watch_;
    Readers readers_;
    std::atomic<UnixMs> ahead_ = 0;       ///< offset of the database's clock; measured with each count
    std::unique_ptr<Listener> listener_;  ///< null behind a pooler
    // Destroyed first, after they have finished their queues. Changes of many rows have a connection of their own, so
    // that single jobs never wait behind a batch; and so have results, which are long, so that accepting a job never
    // waits behind them.
    Writer writer_;
    Writer results_;
    Writer bulk_;
    Slices<Work> slices_{[this](std::function<void(Work&)> apply, Slices<Work>::Finished done) {
        bulk_.change({std::move(apply), std::move(done)});
    }};
};

void PostgresStore::reclaim(Reclaim what, Done<Recovery> done) {
    using Reclaimed = std::pair<Recovery, Unsettled>;
    const UnixMs now = what.now;
    write<Reclaimed>(
        kBulky,
        [what = std::move(what)](Work& work) {
            const std::optional<Recovery> recovery = reclaim_jobs(work.session, what);
            if (!recovery) return Reclaimed{};
            if (recovery->interrupted > 0) work.notices.queued();
            for (const std::string& id : recovery->ended) work.notices.ended(id);
            return Reclaimed{*recovery, settle_batches(work.session)};
        },
        [this, now, done = std::move(done)](Outcome<Reclaimed> outcome) {
            if (const auto* fault = std::get_if<StoreFault>(&outcome)) return done(*fault);
            auto& [recovery, unsettled] = std::get<Reclaimed>(outcome);
            slices_.go_on(unsettled, now);
            done(std::move(recovery));
        });
}

}  // namespace
}  // namespace postgres

std::unique_ptr<JobStore> open_postgres_store(const std::string& uri, SchemaSteps steps, bool pooled) {
    const postgres::Address address(uri, pooled);
    return opening(address.shown(), [&] {
        postgres::Session session(address);
        const SchemaState state = postgres::schema_state(session);
        if (state.have < state.known && steps == SchemaSteps::leave) throw SchemaBehind(state);
        if (state.have < state.known) postgres::migrate(session);
        return std::make_unique<postgres::PostgresStore>(address, random_hex(6));
    });
}

void migrate_postgres(const std::string& uri, const std::string& grant, std::ostream& out) {
    const postgres::Address address(uri);
    opening(address.shown(), [&] {
        postgres::Session session(address);
        const SchemaState state = postgres::schema_state(session);
        if (state.have < state.known) postgres::migrate(session);
        out << "The schema is at step " << state.known << "; it was at " << state.have << ".\n";
        if (grant.empty()) return;
        postgres::grant_use(session, grant);
        out << "The role " << grant << " may read and write its rows.\n";
    });
}

}  // namespace tunewright::server
