// One store seen by several processes: each has a view of its own, over one real store. A view can be deaf (it gets no
// notices), mute (its heartbeats and results do not reach the store: its process seems dead), lossy (its claims are
// executed, but the answer is lost) or out of order (every write fails).
#pragma once

#include <atomic>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/store/store.h"

namespace tunewright::server {

class SharedStore;

/// Forwards notices from one view to all others.
class NoticeBoard {
public:
    void add(SharedStore* view);
    void tell(const SharedStore* from, const StoreNotice& notice);

private:
    std::mutex mutex_;
    std::vector<SharedStore*> views_;
};

class SharedStore : public JobStore {
public:
    SharedStore(JobStore& store, NoticeBoard& board) : store_(store), board_(board) { board_.add(this); }

    std::atomic<bool> deaf = false;
    std::atomic<bool> mute = false;
    std::atomic<bool> lossy = false;
    std::atomic<bool> broken = false;
    std::atomic<int> claims = 0;        ///< number of calls so far
    std::atomic<int> reclaims = 0;      ///< number of calls so far
    std::atomic<UnixMs> last_beat = 0;  ///< time of the last heartbeat that reached the store

    void hear(const StoreNotice& notice) {
        const std::lock_guard lock(mutex_);
        if (!deaf && notify_) notify_(notice);
    }

    bool shared() const override { return true; }
    void watch(std::function<void(const StoreNotice&)> notify) override {
        const std::lock_guard lock(mutex_);
        notify_ = std::move(notify);
    }
    bool healthy() const override { return !broken && store_.healthy(); }
    /// A process that recovers while others work must leave their jobs alone, which their heartbeats show.
    Recovery recover(UnixMs, int, const std::string&) override { return {}; }
    void reclaim(Reclaim what, Done<Recovery> done) override {
        reclaims++;
        write(done, [&] { store_.reclaim(std::move(what), done); });
    }
    std::optional<JobRecord> find(const std::string& id) override { return store_.find(id); }
    std::vector<JobState> states(const std::vector<std::string>& ids) override { return store_.states(ids); }
    std::optional<JobState> job_of_key(const std::string& owner, const std::string& key) override {
        return store_.job_of_key(owner, key);
    }
    JobPage list(const JobQuery& query) override { return store_.list(query); }
    QueueDepth depth() override { return store_.depth(); }
    void pause(bool paused, Done<bool> done) override {
        write(done, [&] {
            store_.pause(paused, [this, paused, done](Outcome<bool> outcome) {
                done(std::move(outcome));
                if (!paused) board_.tell(this, {StoreNotice::Kind::queued, ""});
            });
        });
    }
    void accept(NewJob job, Done<Accepted> done) override {
        write(done, [&] {
            store_.accept(std::move(job), [this, done](Outcome<Accepted> outcome) {
                done(std::move(outcome));
                board_.tell(this, {StoreNotice::Kind::queued, ""});
            });
        });
    }
    void claim(Claim claim, Done<std::vector<JobRecord>> done) override {
        claims++;
        if (mute) return done(std::vector<JobRecord>{});
        write(done, [&] {
            store_.claim(std::move(claim), [done, lost = lossy.load()](Outcome<std::vector<JobRecord>> outcome) {
                if (lost) return done(StoreFault{StoreFault::Kind::unknown, "lossy"});
                done(std::move(outcome));
            });
        });
    }
    void beat(Heartbeat beat, Done<std::vector<Holding>> done) override {
        if (mute) return done(StoreFault{StoreFault::Kind::unavailable, "mute"});
        write(done, [&] {
            const UnixMs at = beat.now;
            store_.beat(std::move(beat), [this, at, done](Outcome<std::vector<Holding>> outcome) {
                done(std::move(outcome));
                last_beat = at;
            });
        });
    }
    void finish(JobEnd end, Done<bool> done) override {
        if (mute) return done(StoreFault{StoreFault::Kind::unavailable, "mute"});
        write(done, [&] {
            store_.finish(end, [this, id = end.id, done](Outcome<bool> outcome) {
                done(std::move(outcome));
                board_.tell(this, {StoreNotice::Kind::ended, id});
            });
        });
    }
    void release(std::int64_t seq, int attempts, Done<bool> done) override {
        write(done, [&] {
            store_.release(seq, attempts, [this, done](Outcome<bool> outcome) {
                done(std::move(outcome));
                board_.tell(this, {StoreNotice::Kind::queued, ""});
            });
        });
    }
    void cancel(std::string id, UnixMs now, Done<CancelEffect> done) override {
        write(done, [&] {
            store_.cancel(id, now, [this, id, done](Outcome<CancelEffect> outcome) {
                done(std::move(outcome));
                board_.tell(this, {StoreNotice::Kind::cancel, id});
            });
        });
    }
    void start_due(UnixMs now, Done<std::size_t> done) override {
        write(done, [&] { store_.start_due(now, done); });
    }
    void requeue(std::string id, Done<RequeueEffect> done) override {
        write(done, [&] {
            store_.requeue(std::move(id), [this, done](Outcome<RequeueEffect> outcome) {
                done(std::move(outcome));
                board_.tell(this, {StoreNotice::Kind::queued, ""});
            });
        });
    }
    void remove(std::string id, Done<RemoveEffect> done) override { store_.remove(std::move(id), done); }
    void open_batch(NewBatch batch, Done<bool> done) override { store_.open_batch(std::move(batch), done); }
    void add_entries(std::string batch, std::vector<NewEntry> entries, UnixMs now, Done<bool> done) override {
        store_.add_entries(std::move(batch), std::move(entries), now, done);
    }
    void seal_batch(BatchSeal seal, Done<Sealed> done) override { store_.seal_batch(std::move(seal), std::move(done)); }
    void drop_batch(std::string batch, Done<bool> done) override { store_.drop_batch(std::move(batch), done); }
    std::optional<BatchSummary> find_batch(const std::string& id) override { return store_.find_batch(id); }
    std::optional<std::string> batch_of_key(const std::string& owner, const std::string& key) override {
        return store_.batch_of_key(owner, key);
    }
    BatchPage list_batches(const std::optional<std::string>& owner, int limit,
                           std::optional<std::int64_t> before_seq) override {
        return store_.list_batches(owner, limit, before_seq);
    }
    std::vector<BatchRow> batch_rows(const std::string& id, std::int64_t from, std::size_t limit) override {
        return store_.batch_rows(id, from, limit);
    }
    void cancel_batch(std::string id, UnixMs now, Done<std::optional<std::vector<std::string>>> done) override {
        store_.cancel_batch(std::move(id), now, done);
    }
    void remove_batch(std::string id, Done<RemoveEffect> done) override { store_.remove_batch(std::move(id), done); }
    void sweep(UnixMs now, Retention retention, std::size_t max, Done<std::size_t> done) override {
        store_.sweep(now, retention, max, done);
    }
    void take_deliveries(UnixMs now, std::chrono::milliseconds hold, std::size_t max,
                         Done<std::vector<Delivery>> done) override {
        write(done, [&] { store_.take_deliveries(now, hold, max, done); });
    }
    void settle_delivery(std::int64_t seq, UnixMs now, std::optional<std::chrono::milliseconds> pause, bool tried,
                         Done<bool> done) override {
        write(done, [&] { store_.settle_delivery(seq, now, pause, tried, done); });
    }

private:
    template <class D, class Work>
    void write(const D& done, Work work) {
        if (broken) return done(StoreFault{StoreFault::Kind::full, "out of order"});
        work();
    }

    JobStore& store_;
    NoticeBoard& board_;
    std::mutex mutex_;
    std::function<void(const StoreNotice&)> notify_;
};

inline void NoticeBoard::add(SharedStore* view) {
    const std::lock_guard lock(mutex_);
    views_.push_back(view);
}

inline void NoticeBoard::tell(const SharedStore* from, const StoreNotice& notice) {
    const std::lock_guard lock(mutex_);
    for (SharedStore* view : views_)
        if (view != from) view->hear(notice);
}

}  // namespace tunewright::server
