// Requirements on every store: the fixture of the tests in store_*_conformance.cpp. A store's own test instantiates
// them with a function that opens it, repeatedly in the same place, to see which data survive.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "server/store/store.h"

namespace tunewright::server {

/// Waits for a store's callback.
template <class T, class Start>
T completed(Start start) {
    std::promise<Outcome<T>> promise;
    start([&](Outcome<T> outcome) { promise.set_value(std::move(outcome)); });
    Outcome<T> outcome = promise.get_future().get();
    if (const auto* fault = std::get_if<StoreFault>(&outcome)) throw std::runtime_error(fault->detail);
    return std::get<T>(std::move(outcome));
}

/// A place for a store, empty at first; open() may be called again after the previous store is destroyed.
class StorePlace {
public:
    virtual ~StorePlace() = default;
    virtual std::unique_ptr<JobStore> open() = 0;
};

/// Makes a place, or returns null if it is not available here.
using MakePlace = std::function<std::unique_ptr<StorePlace>()>;

class StoreConformance : public testing::TestWithParam<MakePlace> {
protected:
    using Ids = std::vector<std::string>;
    using Milliseconds = std::chrono::milliseconds;
    /// The lease of a worker that is dead as soon as it has its jobs, and of one that outlives the test. Workers with
    /// the same name share a lease: a worker that is to die needs a name of its own.
    static constexpr Milliseconds kDead{0};
    static constexpr Milliseconds kAlive{600'000};

    void SetUp() override {
        place_ = GetParam()();
        if (!place_) GTEST_SKIP() << "no place for this store here";
        reopen();
    }

    /// No store's clock is later: a job ends no earlier than it began.
    static constexpr UnixMs kIn2096{4'000'000'000'000};

    Recovery reopen(int max_attempts = 10, UnixMs at = 9000) {
        store_.reset();
        store_ = place_->open();
        return store_->recover(at, max_attempts, kGivenUp);
    }

    static UnixMs now() { return wall_clock(); }
    /// Later than the current time of a store's own clock.
    static UnixMs soon() { return now() + 1000; }

    // ---- jobs
    static NewJob job(const std::string& id, const std::string& flow = "") {
        NewJob made;
        made.id = id;
        made.name = "name of " + id;
        made.timeout_s = 12.5;
        made.request = R"({"plant":")" + id + "\"}";
        made.request_hash = "hash of " + id;
        made.flow = flow;
        made.created_at = 1000;
        return made;
    }
    static NewJob low_job(const std::string& id, const std::string& flow = "") {
        NewJob made = job(id, flow);
        made.priority = Priority::low;
        return made;
    }
    /// A job with a notification.
    static NewJob noted_job(const std::string& id) {
        NewJob made = job(id);
        made.notify = {"https://example.org/" + id, "main"};
        return made;
    }

    Accepted accept(NewJob made) {
        return completed<Accepted>([&](auto done) { store_->accept(std::move(made), done); });
    }
    std::vector<JobRecord> claim_by(const Claim& claim) {
        return completed<std::vector<JobRecord>>([&](auto done) { store_->claim(claim, done); });
    }
    std::vector<JobRecord> claim_many(std::size_t max, Milliseconds lease = kAlive,
                                      const std::string& worker = "worker") {
        return claim_by({worker, now(), lease, max});
    }
    std::optional<JobRecord> claim(Milliseconds lease = kAlive, const std::string& worker = "worker") {
        std::vector<JobRecord> claimed = claim_many(1, lease, worker);
        if (claimed.empty()) return std::nullopt;
        return std::move(claimed.front());
    }
    /// Ids in the order of claiming, until none waits.
    Ids claim_all() {
        Ids ids;
        for (auto claimed = claim(); claimed; claimed = claim()) ids.push_back(claimed->id);
        return ids;
    }
    /// 0 if there is no such job.
    std::int64_t seq_of(const std::string& id) {
        const std::optional<JobRecord> found = store_->find(id);
        return found ? found->seq : 0;
    }
    JobEnd end_of(const std::string& id, JobStatus status, const std::string& result, const std::string& error = "",
                  int attempts = 1, UnixMs finished_at = 3000) {
        return {seq_of(id), id, attempts, status, result, error, "1.2.3", finished_at};
    }
    bool finish(const JobEnd& end) {
        return completed<bool>([&](auto done) { store_->finish(end, done); });
    }
    bool finish(const std::string& id, JobStatus status, const std::string& result, const std::string& error = "",
                int attempts = 1, UnixMs finished_at = 3000) {
        return finish(end_of(id, status, result, error, attempts, finished_at));
    }
    bool release(const std::string& id, int attempts = 1) {
        const std::int64_t seq = seq_of(id);
        return completed<bool>([&](auto done) { store_->release(seq, attempts, done); });
    }
    CancelEffect cancel(const std::string& id) {
        return completed<CancelEffect>([&](auto done) { store_->cancel(id, 2500, done); });
    }
    RequeueEffect requeue(const std::string& id) {
        return completed<RequeueEffect>([&](auto done) { store_->requeue(id, done); });
    }
    RemoveEffect remove(const std::string& id) {
        return completed<RemoveEffect>([&](auto done) { store_->remove(id, done); });
    }
    std::size_t sweep(UnixMs at, const Retention& retention, std::size_t max = 10) {
        return completed<std::size_t>([&](auto done) { store_->sweep(at, retention, max, done); });
    }
    /// Sweeps jobs in any final state.
    std::size_t sweep(UnixMs ended_before, std::size_t max) {
        constexpr Milliseconds none{0};
        return sweep(ended_before, {none, none, none}, max);
    }
    void pause(bool paused) {
        EXPECT_TRUE(completed<bool>([&](auto done) { store_->pause(paused, done); }));
    }
    /// Jobs in the queue, including those of batches.
    std::size_t waiting() { return store_->depth().single + store_->depth().entries; }
    JobStatus status(const std::string& id) { return store_->find(id).value().status; }

    // ---- heartbeats
    ProgressNote note(const std::string& id, const std::string& progress, int attempts = 1) {
        return {seq_of(id), id, attempts, progress};
    }
    /// The jobs that the store has recorded for that worker, in the order of acceptance.
    std::vector<Holding> beat(const std::string& worker = "worker", Milliseconds lease = kAlive,
                              std::vector<ProgressNote> progress = {}) {
        const Heartbeat beat{worker, now(), lease, std::move(progress)};
        auto found = completed<std::vector<Holding>>([&](auto done) { store_->beat(beat, done); });
        std::sort(found.begin(), found.end(), [](const Holding& a, const Holding& b) { return a.seq < b.seq; });
        return found;
    }
    /// Only the numbers of these jobs.
    std::vector<std::int64_t> holdings(const std::string& worker = "worker", Milliseconds lease = kAlive) {
        std::vector<std::int64_t> seqs;
        for (const Holding& holding : beat(worker, lease)) seqs.push_back(holding.seq);
        return seqs;
    }
    /// The worker's record of that job; empty if it is not the worker's.
    std::optional<Holding> holding(const std::string& id, const std::string& worker = "worker") {
        const std::int64_t seq = seq_of(id);
        for (const Holding& holding : beat(worker))
            if (holding.seq == seq) return holding;
        return std::nullopt;
    }
    Recovery reclaim(int max_attempts = 10) {
        return completed<Recovery>([&](auto done) { store_->reclaim({now(), max_attempts, kGivenUp}, done); });
    }

    // ---- batches
    void open_batch(const NewBatch& batch) {
        EXPECT_TRUE(completed<bool>([&](auto done) { store_->open_batch(batch, done); }));
    }
    void open_batch(const std::string& id, const std::string& owner = "", const std::string& flow = "") {
        open_batch({id, "name of " + id, owner, flow, now()});
    }
    /// The id of entry i of a batch is "<batch>-<i>".
    static NewEntry entry(const std::string& batch, std::int64_t index, const std::string& error = "") {
        NewEntry made;
        made.index = index;
        made.id = batch + "-" + std::to_string(index);
        made.name = "name of " + made.id;
        made.timeout_s = 12.5;
        if (error.empty()) made.request = R"({"plant":")" + made.id + "\"}";
        made.request_hash = "hash of " + made.id;
        made.error = error;
        return made;
    }
    bool add_entries(const std::string& batch, std::vector<NewEntry> entries) {
        return completed<bool>([&](auto done) { store_->add_entries(batch, std::move(entries), now(), done); });
    }
    bool add_waiting(const std::string& batch, std::int64_t first, std::int64_t count) {
        std::vector<NewEntry> entries;
        for (std::int64_t i = first; i < first + count; i++) entries.push_back(entry(batch, i));
        return add_entries(batch, std::move(entries));
    }
    Sealed seal(const std::string& batch, const std::string& key = "", const std::string& hash = "hash",
                const std::string& name = "") {
        return completed<Sealed>([&](auto done) { store_->seal_batch({batch, hash, key, name}, done); });
    }
    bool drop(const std::string& batch) {
        return completed<bool>([&](auto done) { store_->drop_batch(batch, done); });
    }
    std::optional<Ids> cancel_batch(const std::string& batch) {
        return completed<std::optional<Ids>>([&](auto done) { store_->cancel_batch(batch, now(), done); });
    }
    RemoveEffect remove_batch(const std::string& batch) {
        return completed<RemoveEffect>([&](auto done) { store_->remove_batch(batch, done); });
    }
    /// A sealed batch with this number of waiting entries.
    void make_batch(const NewBatch& batch, std::int64_t count) {
        open_batch(batch);
        add_waiting(batch.id, 0, count);
        EXPECT_EQ(seal(batch.id).kind, Sealed::Kind::sealed);
    }
    void make_batch(const std::string& id, std::int64_t count, const std::string& flow = "") {
        make_batch({id, "name of " + id, "", flow, now()}, count);
    }
    BatchSummary batch(const std::string& id) { return store_->find_batch(id).value(); }

    // ---- deliveries
    std::vector<Delivery> take(UnixMs at, std::size_t max = 100, Milliseconds hold = kAlive) {
        return completed<std::vector<Delivery>>([&](auto done) { store_->take_deliveries(at, hold, max, done); });
    }
    bool settle(std::int64_t seq, UnixMs at = 0, std::optional<Milliseconds> pause = std::nullopt) {
        return completed<bool>([&](auto done) { store_->settle_delivery(seq, at, pause, true, done); });
    }
    /// Ids of the jobs and batches with a pending notification; all are settled.
    Ids tell() {
        Ids ids;
        for (const Delivery& delivery : take(soon())) {
            ids.push_back(delivery.job + delivery.batch);
            EXPECT_TRUE(settle(delivery.seq));
        }
        return ids;
    }

    static constexpr const char* kGivenUp = R"({"type":"given-up"})";
    std::unique_ptr<StorePlace> place_;
    std::unique_ptr<JobStore> store_;
};

}  // namespace tunewright::server
