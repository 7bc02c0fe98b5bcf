// A store that measures each operation of the one inside it.
#include "server/store/metered_store.h"

#include <chrono>

namespace tunewright::server {
namespace {

using Clock = std::chrono::steady_clock;

class MeteredStore : public JobStore {
public:
    MeteredStore(std::unique_ptr<JobStore> store, StoreMeter meter)
        : meter_(std::move(meter)), store_(std::move(store)) {}

    bool shared() const override { return store_->shared(); }
    void watch(std::function<void(const StoreNotice&)> listener) override { store_->watch(std::move(listener)); }
    bool healthy() const override { return store_->healthy(); }
    std::chrono::milliseconds clock_ahead() const override { return store_->clock_ahead(); }

    Recovery recover(UnixMs now, int attempts, const std::string& error) override {
        return timed("recover", [&] { return store_->recover(now, attempts, error); });
    }
    void reclaim(Reclaim what, Done<Recovery> done) override {
        store_->reclaim(std::move(what), timed("reclaim", std::move(done)));
    }
    std::optional<JobRecord> find(const std::string& id) override {
        return timed("find", [&] { return store_->find(id); });
    }
    std::optional<JobState> job_of_key(const std::string& owner, const std::string& idempotency_key) override {
        return timed("job_of_key", [&] { return store_->job_of_key(owner, idempotency_key); });
    }
    std::vector<JobState> states(const std::vector<std::string>& ids) override {
        return timed("states", [&] { return store_->states(ids); });
    }
    JobPage list(const JobQuery& query) override {
        return timed("list", [&] { return store_->list(query); });
    }
    QueueDepth depth() override {
        return timed("depth", [&] { return store_->depth(); });
    }
    void accept(NewJob job, Done<Accepted> done) override {
        store_->accept(std::move(job), timed("accept", std::move(done)));
    }
    void claim(Claim claim, Done<std::vector<JobRecord>> done) override {
        store_->claim(std::move(claim), timed("claim", std::move(done)));
    }
    void beat(Heartbeat beat, Done<std::vector<Holding>> done) override {
        store_->beat(std::move(beat), timed("beat", std::move(done)));
    }
    void finish(JobEnd end, Done<bool> done) override {
        store_->finish(std::move(end), timed("finish", std::move(done)));
    }
    void release(std::int64_t seq, int attempts, Done<bool> done) override {
        store_->release(seq, attempts, timed("release", std::move(done)));
    }
    void cancel(std::string id, UnixMs now, Done<CancelEffect> done) override {
        store_->cancel(std::move(id), now, timed("cancel", std::move(done)));
    }
    void start_due(UnixMs now, Done<std::size_t> done) override {
        store_->start_due(now, timed("start_due", std::move(done)));
    }
    void requeue(std::string id, Done<RequeueEffect> done) override {
        store_->requeue(std::move(id), timed("requeue", std::move(done)));
    }
    void pause(bool paused, Done<bool> done) override { store_->pause(paused, timed("pause", std::move(done))); }
    void remove(std::string id, Done<RemoveEffect> done) override {
        store_->remove(std::move(id), timed("remove", std::move(done)));
    }
    void open_batch(NewBatch batch, Done<bool> done) override {
        store_->open_batch(std::move(batch), timed("open_batch", std::move(done)));
    }
    void add_entries(std::string batch, std::vector<NewEntry> entries, UnixMs now, Done<bool> done) override {
        store_->add_entries(std::move(batch), std::move(entries), now, timed("add_entries", std::move(done)));
    }
    void seal_batch(BatchSeal seal, Done<Sealed> done) override {
        store_->seal_batch(std::move(seal), timed("seal_batch", std::move(done)));
    }
    void drop_batch(std::string batch, Done<bool> done) override {
        store_->drop_batch(std::move(batch), timed("drop_batch", std::move(done)));
    }
    std::optional<BatchSummary> find_batch(const std::string& id) override {
        return timed("find_batch", [&] { return store_->find_batch(id); });
    }
    std::optional<std::string> batch_of_key(const std::string& owner, const std::string& key) override {
        return timed("batch_of_key", [&] { return store_->batch_of_key(owner, key); });
    }
    BatchPage list_batches(const std::optional<std::string>& owner, int limit,
                           std::optional<std::int64_t> before_seq) override {
        return timed("list_batches", [&] { return store_->list_batches(owner, limit, before_seq); });
    }
    std::vector<BatchRow> batch_rows(const std::string& id, std::int64_t from, std::size_t limit) override {
        return timed("batch_rows", [&] { return store_->batch_rows(id, from, limit); });
    }
    void cancel_batch(std::string id, UnixMs now, Done<std::optional<std::vector<std::string>>> done) override {
        store_->cancel_batch(std::move(id), now, timed("cancel_batch", std::move(done)));
    }
    void remove_batch(std::string id, Done<RemoveEffect> done) override {
        store_->remove_batch(std::move(id), timed("remove_batch", std::move(done)));
    }
    void sweep(UnixMs now, Retention retention, std::size_t max, Done<std::size_t> done) override {
        store_->sweep(now, retention, max, timed("sweep", std::move(done)));
    }
    void take_deliveries(UnixMs now, std::chrono::milliseconds hold, std::size_t max,
                         Done<std::vector<Delivery>> done) override {
        store_->take_deliveries(now, hold, max, timed("take_deliveries", std::move(done)));
    }
    void settle_delivery(std::int64_t seq, UnixMs now, std::optional<std::chrono::milliseconds> pause, bool tried,
                         Done<bool> done) override {
        store_->settle_delivery(seq, now, pause, tried, timed("settle_delivery", std::move(done)));
    }

private:
    void measure(std::string_view operation, Clock::time_point start, bool done) const {
        meter_(operation, std::chrono::duration<double>(Clock::now() - start).count(), done);
    }

    template <class T>
    Done<T> timed(std::string_view operation, Done<T> done) const {
        return [this, operation, start = Clock::now(), done = std::move(done)](Outcome<T> outcome) {
            measure(operation, start, std::holds_alternative<T>(outcome));
            done(std::move(outcome));
        };
    }

    template <class Work>
    auto timed(std::string_view operation, Work work) const -> decltype(work()) {
        const Clock::time_point start = Clock::now();
        try {
            auto value = work();
            measure(operation, start, true);
            return value;
        } catch (...) {
            measure(operation, start, false);
            throw;
        }
    }

    // The store is destroyed first: it still answers while it is being closed.
    StoreMeter meter_;
    std::unique_ptr<JobStore> store_;
};

}  // namespace

std::unique_ptr<JobStore> metered(std::unique_ptr<JobStore> store, StoreMeter meter) {
    return std::make_unique<MeteredStore>(std::move(store), std::move(meter));
}

}  // namespace tunewright::server
