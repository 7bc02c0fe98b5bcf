// What every store must do, whatever it is made of: the fixture of the tests in store_*_conformance.cpp. A store's own
// test instantiates them with a way to open it: again and again on the same place, to see what survives.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <set>
#include <string>
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

/// Changes of jobs that a store's tables must refuse, of the jobs "ended", "running" and "waiting" in these states:
/// what follows UPDATE ... SET.
inline constexpr const char* kForbiddenChanges[] = {
    "status = 'queued', finished_at = NULL WHERE id = 'ended'",
    "status = 'failed' WHERE id = 'ended'",
    "attempts = 0 WHERE id = 'running'",
    "attempts = 5 WHERE id = 'running'",
    "worker = NULL WHERE id = 'running'",
    "lease_until = NULL WHERE id = 'running'",
    "status = 'succeeded', worker = NULL, lease_until = NULL WHERE id = 'running'",
    "status = 'succeeded', finished_at = 1 WHERE id = 'waiting'",
    "status = 'running' WHERE id = 'waiting'",
    "finished_at = 1 WHERE id = 'waiting'",
};

/// A place for a store, empty at first; open() may be called again after the store before has gone.
class StorePlace {
public:
    virtual ~StorePlace() = default;
    virtual std::unique_ptr<JobStore> open() = 0;
};

/// Makes a place, or says by nothing that it is not to be had here.
using MakePlace = std::function<std::unique_ptr<StorePlace>()>;

class StoreConformance : public testing::TestWithParam<MakePlace> {
protected:
    using Ids = std::vector<std::string>;
    /// A worker that holds a job no longer than the call: dead as soon as it has it.
    static constexpr std::chrono::milliseconds kDead{0};
    static constexpr std::chrono::milliseconds kAlive{600'000};

    void SetUp() override {
        place_ = GetParam()();
        if (!place_) GTEST_SKIP() << "no place for this store here";
        reopen();
    }

    Recovery reopen(int most_attempts = 10) {
        store_.reset();
        store_ = place_->open();
        return store_->recover(9000, most_attempts, kGivenUp);
    }

    static UnixMs now() {
        using std::chrono::system_clock;
        return std::chrono::duration_cast<std::chrono::milliseconds>(system_clock::now().time_since_epoch()).count();
    }

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

    Accepted accept(NewJob made) {
        return completed<Accepted>([&](auto done) { store_->accept(std::move(made), done); });
    }
    std::vector<JobRecord> claim_many(std::size_t most, std::chrono::milliseconds lease = kAlive,
                                      const std::string& worker = "worker") {
        const Claim claim{worker, now(), lease, most};
        return completed<std::vector<JobRecord>>([&](auto done) { store_->claim(claim, done); });
    }
    std::optional<JobRecord> claim(std::chrono::milliseconds lease = kAlive, const std::string& worker = "worker") {
        std::vector<JobRecord> claimed = claim_many(1, lease, worker);
        if (claimed.empty()) return std::nullopt;
        return std::move(claimed.front());
    }
    /// Ids in the order in which they are handed out, until none waits.
    Ids claim_all() {
        Ids ids;
        for (auto claimed = claim(); claimed; claimed = claim()) ids.push_back(claimed->id);
        return ids;
    }
    bool finish(const std::string& id, JobStatus status, const std::string& result, const std::string& error = "",
                int attempts = 1) {
        const JobEnd end{id, attempts, status, result, error, "1.2.3", 3000};
        return completed<bool>([&](auto done) { store_->finish(end, done); });
    }
    bool release(const std::string& id, int attempts = 1) {
        return completed<bool>([&](auto done) { store_->release(id, attempts, done); });
    }
    std::vector<Renewed> renew(std::vector<Renewal> renewals, std::chrono::milliseconds lease = kAlive) {
        return completed<std::vector<Renewed>>(
            [&](auto done) { store_->renew(std::move(renewals), now(), lease, done); });
    }
    Recovery reclaim(int most_attempts = 10) {
        return completed<Recovery>([&](auto done) { store_->reclaim({now(), most_attempts, kGivenUp}, done); });
    }
    CancelEffect cancel(const std::string& id) {
        return completed<CancelEffect>([&](auto done) { store_->cancel(id, 2500, done); });
    }
    RemoveEffect remove(const std::string& id) {
        return completed<RemoveEffect>([&](auto done) { store_->remove(id, done); });
    }
    std::size_t sweep(UnixMs ended_before, std::size_t most) {
        return completed<std::size_t>(
            [&](auto done) { store_->sweep(ended_before, std::chrono::milliseconds(0), most, done); });
    }
    /// Jobs in the queue, those of batches included.
    std::size_t waiting() { return store_->depth().single + store_->depth().entries; }
    JobStatus status(const std::string& id) { return store_->find(id).value().status; }

    void open_batch(const std::string& id, const std::string& owner = "", const std::string& flow = "") {
        const NewBatch batch{id, "name of " + id, owner, flow, now()};
        EXPECT_TRUE(completed<bool>([&](auto done) { store_->open_batch(batch, done); }));
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
    /// A sealed batch of so many waiting entries.
    void make_batch(const std::string& id, std::int64_t count, const std::string& flow = "") {
        open_batch(id, "", flow);
        add_waiting(id, 0, count);
        EXPECT_EQ(seal(id).kind, Sealed::Kind::sealed);
    }
    BatchSummary batch(const std::string& id) { return store_->find_batch(id).value(); }

    static constexpr const char* kGivenUp = R"({"type":"given-up"})";
    std::unique_ptr<StorePlace> place_;
    std::unique_ptr<JobStore> store_;
};

}  // namespace tunewright::server
