#include "server/store/postgres/postgres_store.h"

#include <atomic>
#include <future>

#include "server/clock.h"
#include "server/random.h"
#include "server/store/postgres/changes.h"
#include "server/store/postgres/listener.h"
#include "server/store/postgres/readers.h"
#include "server/store/postgres/reading.h"
#include "server/store/postgres/writer.h"

namespace tunewright::server {
namespace postgres {
namespace {

class PostgresStore : public JobStore {
public:
    PostgresStore(const Address& address, const std::string& tag, std::unique_ptr<Session> session)
        : readers_(address),
          listener_(address, tag),
          writer_(address, tag, std::move(session)),
          bulk_(address, tag, nullptr) {
        PostgresStore::depth();  // its clock is known from the start
    }

    bool shared() const override { return true; }
    void watch(std::function<void(const StoreNotice&)> notify) override { listener_.watch(std::move(notify)); }
    bool healthy() const override { return writer_.healthy() && bulk_.healthy(); }

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
    std::vector<JobState> states(const std::vector<std::string>& ids) override {
        if (ids.empty()) return {};
        return readers_.read([&](Session& session) { return find_states(session, ids); });
    }
    JobPage list(const JobQuery& query) override {
        return readers_.read([&](Session& session) { return list_jobs(session, query); });
    }
    Depth depth() override {
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
    void renew(std::vector<Renewal> renewals, UnixMs, std::chrono::milliseconds lease,
               Done<std::vector<Renewed>> done) override {
        writer_.renew({{std::move(renewals), lease}, std::move(done)});
    }
    void finish(JobEnd end, Done<bool> done) override { writer_.finish({std::move(end), std::move(done)}); }
    void release(std::string id, int attempts, Done<bool> done) override {
        const auto work = [this, id = std::move(id), attempts](Session& session, Notices& notices) {
            const std::optional<JobStatus> status = release_job(session, id, attempts, wall_clock() + ahead_);
            if (status == JobStatus::queued) notices.queued();
            if (status == JobStatus::cancelled) notices.ended(id);
            return status.has_value();
        };
        write<bool>(kQuick, work, std::move(done));
    }
    void cancel(std::string id, UnixMs now, Done<CancelEffect> done) override {
        const auto work = [id = std::move(id), now](Session& session, Notices& notices) {
            const CancelEffect effect = cancel_job(session, id, now);
            if (effect == CancelEffect::cancelled) notices.ended(id);
            if (effect == CancelEffect::requested) notices.cancel(id);
            return effect;
        };
        write<CancelEffect>(kQuick, work, std::move(done));
    }
    void remove(std::string id, Done<RemoveEffect> done) override {
        const auto work = [id = std::move(id)](Session& session, Notices&) { return remove_job(session, id); };
        write<RemoveEffect>(kQuick, work, std::move(done));
    }

    void open_batch(NewBatch batch, Done<bool> done) override {
        const auto work = [batch = std::move(batch)](Session& session, Notices&) {
            postgres::open_batch(session, batch);
            return true;
        };
        write<bool>(kBulky, work, std::move(done));
    }
    void add_entries(std::string batch, std::vector<NewEntry> entries, UnixMs now, Done<bool> done) override {
        const auto work = [batch = std::move(batch), entries = std::move(entries), now](Session& session,
                                                                                        Notices& notices) {
            const bool added = postgres::add_entries(session, batch, entries, now);
            if (added && !entries.empty()) notices.queued();
            return added;
        };
        write<bool>(kBulky, work, std::move(done));
    }
    void seal_batch(BatchSeal seal, Done<Sealed> done) override;
    void drop_batch(std::string batch, Done<bool> done) override;
    void cancel_batch(std::string id, UnixMs now, Done<std::optional<std::vector<std::string>>> done) override;
    void remove_batch(std::string id, Done<RemoveEffect> done) override;
    void sweep(UnixMs now, std::chrono::milliseconds age, std::size_t most, Done<std::size_t> done) override {
        sweep_on({now, age}, most, 0, std::move(done));
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
    using Ids = std::vector<std::string>;

    /// Queues `work` for the writer and passes its value on after the commit.
    template <class T, class Work>
    void write(Manner manner, Work work, Done<T> done) {
        auto value = std::make_shared<T>();
        OtherChange change;
        change.apply = [value, work = std::move(work)](Session& session, Notices& notices) {
            *value = work(session, notices);
        };
        change.done = [value, done = std::move(done)](const std::optional<StoreFault>& fault) {
            fault ? done(*fault) : done(std::move(*value));
        };
        (manner == kBulky ? bulk_ : writer_).change(std::move(change));
    }

    void delete_batch(std::int64_t batch, std::function<void(std::optional<StoreFault>)> done);
    void cancel_slices(std::int64_t batch, std::int64_t from, UnixMs now, Done<Ids> done);
    void sweep_on(const Retention& retention, std::size_t most, std::size_t gone, Done<std::size_t> done);

    Readers readers_;
    std::atomic<UnixMs> ahead_ = 0;  ///< the database's clock, before ours; measured with each count
    Listener listener_;
    // The first to go: they end what was asked for. What touches many rows has a connection of its own, so that jobs
    // which somebody waits for never wait behind a batch.
    Writer writer_;
    Writer bulk_;
};

void PostgresStore::reclaim(Reclaim what, Done<Recovery> done) {
    struct Found {
        Recovery recovery;
        Unsettled unsettled;
    };
    const UnixMs now = what.now;
    const auto work = [what = std::move(what)](Session& session, Notices& notices) {
        Found found;
        if (what.leases) found.recovery = reclaim_jobs(session, what.now, what.most_attempts, what.error);
        found.unsettled = find_unsettled(session);
        if (found.recovery.interrupted > 0) notices.queued();
        for (const std::string& id : found.recovery.ended) notices.ended(id);
        return found;
    };
    write<Found>(kBulky, work, [this, now, done = std::move(done)](Outcome<Found> outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) return done(*fault);
        auto& found = std::get<Found>(outcome);
        for (const std::int64_t batch : found.unsettled.leaving)
            delete_batch(batch, [](const std::optional<StoreFault>&) {});
        for (const std::int64_t batch : found.unsettled.cancelling)
            cancel_slices(batch, 0, now, [](const Outcome<Ids>&) {});
        done(std::move(found.recovery));
    });
}

// ---- long changes, slice by slice --------------------------------------------------------------------------------

void PostgresStore::delete_batch(std::int64_t batch, std::function<void(std::optional<StoreFault>)> done) {
    const auto work = [batch](Session& session, Notices&) { return delete_entries(session, batch, kSlice); };
    write<std::size_t>(kBulky, work, [this, batch, done = std::move(done)](const Outcome<std::size_t>& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) return done(*fault);
        std::get<std::size_t>(outcome) > 0 ? delete_batch(batch, done) : done(std::nullopt);
    });
}

void PostgresStore::seal_batch(BatchSeal seal, Done<Sealed> done) {
    const auto work = [seal = std::move(seal)](Session& session, Notices&) {
        return postgres::seal_batch(session, seal);
    };
    write<SealedBatch>(kBulky, work, [this, done = std::move(done)](Outcome<SealedBatch> outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) return done(*fault);
        auto& sealed = std::get<SealedBatch>(outcome);
        if (!sealed.leaving) return done(std::move(sealed.answer));
        delete_batch(*sealed.leaving, [answer = std::move(sealed.answer), done](const std::optional<StoreFault>&) {
            done(answer);  // whatever could not be deleted now is not seen, and goes with the next reclaim()
        });
    });
}

void PostgresStore::drop_batch(std::string batch, Done<bool> done) {
    using Found = std::optional<std::int64_t>;
    const auto work = [batch = std::move(batch)](Session& session, Notices&) { return leave_batch(session, batch); };
    write<Found>(kBulky, work, [this, done = std::move(done)](const Outcome<Found>& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) return done(*fault);
        const auto found = std::get<Found>(outcome);
        if (!found) return done(false);
        delete_batch(*found, [done](const std::optional<StoreFault>& fault) { fault ? done(*fault) : done(true); });
    });
}

void PostgresStore::remove_batch(std::string id, Done<RemoveEffect> done) {
    const auto work = [id = std::move(id)](Session& session, Notices&) { return postgres::remove_batch(session, id); };
    write<RemovedBatch>(kBulky, work, [this, done = std::move(done)](const Outcome<RemovedBatch>& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) return done(*fault);
        const auto& removed = std::get<RemovedBatch>(outcome);
        if (removed.effect != RemoveEffect::removed) return done(removed.effect);
        delete_batch(removed.leaving, [done](const std::optional<StoreFault>& fault) {
            fault ? done(*fault) : done(RemoveEffect::removed);
        });
    });
}

void PostgresStore::cancel_batch(std::string id, UnixMs now, Done<std::optional<Ids>> done) {
    using Found = std::optional<std::int64_t>;
    const auto work = [id = std::move(id)](Session& session, Notices&) { return begin_cancel(session, id); };
    write<Found>(kBulky, work, [this, now, done = std::move(done)](const Outcome<Found>& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) return done(*fault);
        const auto found = std::get<Found>(outcome);
        if (!found) return done(std::nullopt);
        cancel_slices(*found, 0, now, [done](Outcome<Ids> ids) {
            if (const auto* fault = std::get_if<StoreFault>(&ids)) return done(*fault);
            done(std::get<Ids>(std::move(ids)));
        });
    });
}

void PostgresStore::cancel_slices(std::int64_t batch, std::int64_t from, UnixMs now, Done<Ids> done) {
    using Next = std::optional<std::int64_t>;
    const auto work = [=](Session& session, Notices&) { return cancel_entries(session, batch, from, now); };
    write<Next>(kBulky, work, [this, batch, now, done = std::move(done)](const Outcome<Next>& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) return done(*fault);
        if (const auto next = std::get<Next>(outcome)) return cancel_slices(batch, *next, now, done);
        const auto end = [batch](Session& session, Notices& notices) {
            Ids ids = end_cancel(session, batch);
            for (const std::string& id : ids) notices.cancel(id);
            notices.ended("");
            return ids;
        };
        write<Ids>(kBulky, end, done);
    });
}

void PostgresStore::sweep_on(const Retention& retention, std::size_t most, std::size_t gone, Done<std::size_t> done) {
    const auto work = [retention, left = most - gone](Session& session, Notices&) {
        return left == 0 ? 0 : sweep_slice(session, retention, left);
    };
    write<std::size_t>(kBulky, work, [=, this, done = std::move(done)](const Outcome<std::size_t>& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) return done(*fault);
        const std::size_t slice = std::get<std::size_t>(outcome);
        slice > 0 ? sweep_on(retention, most, gone + slice, done) : done(gone);
    });
}

}  // namespace
}  // namespace postgres

std::unique_ptr<JobStore> open_postgres_store(const std::string& uri) {
    const postgres::Address address(uri);
    try {
        auto session = std::make_unique<postgres::Session>(address);
        postgres::migrate(*session);
        return std::make_unique<postgres::PostgresStore>(address, random_hex(6), std::move(session));
    } catch (const std::exception& error) {
        throw StoreError(
            {StoreFault::Kind::unavailable, "Cannot open the store " + address.shown() + ": " + error.what() + "."});
    }
}

}  // namespace tunewright::server
