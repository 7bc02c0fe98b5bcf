// What every store must do, whatever it is made of. A store's own test includes this and instantiates the suite with
// a way to open it: twice on the same place, to see what survives.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <future>
#include <memory>
#include <set>

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

/// A place for a store, empty at first; open() may be called again after the store before has gone.
class StorePlace {
public:
    virtual ~StorePlace() = default;
    virtual std::unique_ptr<JobStore> open() = 0;
};

class StoreConformance : public testing::TestWithParam<std::function<std::unique_ptr<StorePlace>()>> {
protected:
    void SetUp() override {
        place_ = GetParam()();
        reopen();
    }

    Recovery reopen(int most_attempts = 10) {
        store_.reset();
        store_ = place_->open();
        return store_->recover(9000, most_attempts, R"({"type":"given-up"})");
    }

    static NewJob job(const std::string& id) {
        NewJob made;
        made.id = id;
        made.name = "name of " + id;
        made.timeout_s = 12.5;
        made.request = R"({"plant":")" + id + "\"}";
        made.request_hash = "hash of " + id;
        made.created_at = 1000;
        return made;
    }

    Accepted accept(NewJob made) {
        return completed<Accepted>([&](auto done) { store_->accept(std::move(made), done); });
    }
    std::optional<JobRecord> claim() {
        return completed<std::optional<JobRecord>>([&](auto done) { store_->claim_next(2000, done); });
    }
    bool finish(const std::string& id, JobStatus status, const std::string& result, const std::string& error = "") {
        return completed<bool>([&](auto done) { store_->finish({id, status, result, error, "1.2.3", 3000}, done); });
    }
    bool release(const std::string& id) {
        return completed<bool>([&](auto done) { store_->release(id, done); });
    }
    CancelEffect cancel(const std::string& id) {
        return completed<CancelEffect>([&](auto done) { store_->cancel(id, 2500, done); });
    }
    RemoveEffect remove(const std::string& id) {
        return completed<RemoveEffect>([&](auto done) { store_->remove(id, done); });
    }
    JobStatus status(const std::string& id) { return store_->find(id).value().status; }

    std::unique_ptr<StorePlace> place_;
    std::unique_ptr<JobStore> store_;
};

TEST_P(StoreConformance, AnAcceptedJobIsReadBackAsItWasGiven) {
    const Accepted accepted = accept(job("a"));
    EXPECT_EQ(accepted.kind, Accepted::Kind::created);
    const JobRecord found = store_->find("a").value();
    EXPECT_EQ(found.seq, accepted.job.seq);
    EXPECT_EQ(found.name, "name of a");
    EXPECT_EQ(found.status, JobStatus::queued);
    EXPECT_EQ(found.request, R"({"plant":"a"})");
    EXPECT_EQ(found.request_hash, "hash of a");
    EXPECT_EQ(found.timeout_s, 12.5);
    EXPECT_EQ(found.created_at, 1000);
    EXPECT_EQ(found.attempts, 0);
    EXPECT_FALSE(found.started_at || found.finished_at);
    EXPECT_FALSE(store_->find("b"));
}

TEST_P(StoreConformance, TextsKeepQuotesZeroBytesAndOtherLanguages) {
    NewJob made = job("a");
    made.name = "Regler \"süß\" 温度'; DROP TABLE jobs; --";
    made.name.push_back('\0');
    made.name += "end";
    const std::string name = made.name;
    accept(made);
    EXPECT_EQ(store_->find("a").value().name, name);
}

TEST_P(StoreConformance, ClaimsComeInTheOrderOfAcceptanceAndEachOnce) {
    for (const char* id : {"c", "a", "b"}) accept(job(id));
    for (const char* id : {"c", "a", "b"}) {
        const JobRecord claimed = claim().value();
        EXPECT_EQ(claimed.id, id);
        EXPECT_EQ(claimed.status, JobStatus::running);
        EXPECT_EQ(claimed.attempts, 1);
        EXPECT_EQ(claimed.started_at, 2000);
        EXPECT_EQ(claimed.request, job(id).request);
    }
    EXPECT_FALSE(claim());
}

TEST_P(StoreConformance, ManyClaimsAtOnceNeverGiveAJobTwice) {
    constexpr int count = 200;
    for (int i = 0; i < count; i++) accept(job("job" + std::to_string(i)));
    std::vector<std::promise<std::optional<JobRecord>>> claims(count + 10);
    for (auto& promise : claims)
        store_->claim_next(2000, [&promise](auto outcome) {
            promise.set_value(std::get<std::optional<JobRecord>>(std::move(outcome)));
        });
    std::set<std::string> ids;
    int none = 0;
    for (auto& promise : claims) {
        const auto claimed = promise.get_future().get();
        claimed ? static_cast<void>(ids.insert(claimed->id)) : static_cast<void>(none++);
    }
    EXPECT_EQ(ids.size(), count);
    EXPECT_EQ(none, 10);
}

TEST_P(StoreConformance, AJobEndsOnceAndKeepsItsFirstEnd) {
    accept(job("a"));
    EXPECT_FALSE(finish("a", JobStatus::succeeded, "{}")) << "it is not running yet";
    claim();
    EXPECT_TRUE(finish("a", JobStatus::succeeded, R"({"x":1})"));
    EXPECT_FALSE(finish("a", JobStatus::failed, "", R"({"type":"late"})"));
    const JobRecord found = store_->find("a").value();
    EXPECT_EQ(found.status, JobStatus::succeeded);
    EXPECT_EQ(found.result, R"({"x":1})");
    EXPECT_EQ(found.error, "");
    EXPECT_EQ(found.finished_at, 3000);
}

TEST_P(StoreConformance, AFailedJobKeepsItsErrorAndACancelledOneItsPartialResult) {
    accept(job("a"));
    accept(job("b"));
    claim();
    claim();
    EXPECT_TRUE(finish("a", JobStatus::failed, "", R"({"type":"timeout"})"));
    EXPECT_TRUE(finish("b", JobStatus::cancelled, R"({"partial":true})"));
    EXPECT_EQ(store_->find("a").value().error, R"({"type":"timeout"})");
    EXPECT_EQ(store_->find("b").value().result, R"({"partial":true})");
}

TEST_P(StoreConformance, CancellingAQueuedJobEndsItAndItIsNeverClaimed) {
    accept(job("a"));
    EXPECT_EQ(cancel("a"), CancelEffect::cancelled);
    EXPECT_EQ(status("a"), JobStatus::cancelled);
    EXPECT_EQ(store_->find("a").value().finished_at, 2500);
    EXPECT_FALSE(claim());
    EXPECT_EQ(cancel("a"), CancelEffect::ended);
    EXPECT_EQ(cancel("b"), CancelEffect::none);
}

TEST_P(StoreConformance, CancellingARunningJobIsRememberedUntilItEnds) {
    accept(job("a"));
    claim();
    EXPECT_EQ(cancel("a"), CancelEffect::requested);
    EXPECT_EQ(status("a"), JobStatus::running);
    EXPECT_TRUE(store_->find("a").value().cancel_requested);
    const Recovery recovery = reopen();
    EXPECT_EQ(recovery.queued, 0U);
    EXPECT_EQ(status("a"), JobStatus::cancelled);
}

TEST_P(StoreConformance, OnlyEndedJobsAreRemovedAndNothingOfThemStays) {
    EXPECT_EQ(remove("a"), RemoveEffect::none);
    NewJob made = job("a");
    made.idempotency_key = "key";
    accept(made);
    EXPECT_EQ(remove("a"), RemoveEffect::not_ended);
    claim();
    EXPECT_EQ(remove("a"), RemoveEffect::not_ended);
    finish("a", JobStatus::succeeded, "{}");
    EXPECT_EQ(remove("a"), RemoveEffect::removed);
    EXPECT_FALSE(store_->find("a"));
    made.id = "b";
    EXPECT_EQ(accept(made).kind, Accepted::Kind::created) << "its idempotency key went with it";
}

TEST_P(StoreConformance, AnIdempotencyKeyFindsTheEarlierJobUnlessTheRequestDiffers) {
    NewJob first = job("a");
    first.idempotency_key = "key";
    accept(first);
    NewJob again = job("b");
    again.idempotency_key = "key";
    again.request_hash = first.request_hash;
    const Accepted same = accept(again);
    EXPECT_EQ(same.kind, Accepted::Kind::existing);
    EXPECT_EQ(same.job.id, "a");
    again.request_hash = "another";
    EXPECT_EQ(accept(again).kind, Accepted::Kind::conflict);
    EXPECT_FALSE(store_->find("b"));
}

TEST_P(StoreConformance, AnInterruptedJobIsQueuedBeforeLaterOnesAndCountsItsAttempts) {
    accept(job("a"));
    accept(job("b"));
    claim();
    const Recovery recovery = reopen();
    EXPECT_EQ(recovery.interrupted, 1U);
    EXPECT_EQ(recovery.queued, 2U);
    const JobRecord claimed = claim().value();
    EXPECT_EQ(claimed.id, "a");
    EXPECT_EQ(claimed.attempts, 2);
}

TEST_P(StoreConformance, AJobThatWasInterruptedTooOftenFails) {
    accept(job("a"));
    claim();
    reopen(2);
    claim();
    const Recovery recovery = reopen(2);
    EXPECT_EQ(recovery.given_up, 1U);
    EXPECT_EQ(recovery.queued, 0U);
    const JobRecord found = store_->find("a").value();
    EXPECT_EQ(found.status, JobStatus::failed);
    EXPECT_EQ(found.error, R"({"type":"given-up"})");
    EXPECT_EQ(found.finished_at, 9000);
}

TEST_P(StoreConformance, AReleasedJobIsQueuedAgain) {
    accept(job("a"));
    EXPECT_FALSE(release("a"));
    claim();
    EXPECT_TRUE(release("a"));
    EXPECT_EQ(status("a"), JobStatus::queued);
    EXPECT_EQ(claim().value().attempts, 2);
}

TEST_P(StoreConformance, WhatHasEndedIsTheSameAfterReopening) {
    accept(job("a"));
    claim();
    finish("a", JobStatus::succeeded, R"({"x":1})");
    const JobRecord before = store_->find("a").value();
    reopen();
    const JobRecord after = store_->find("a").value();
    EXPECT_EQ(after.status, JobStatus::succeeded);
    EXPECT_EQ(after.result, before.result);
    EXPECT_EQ(after.started_at, before.started_at);
    EXPECT_EQ(after.finished_at, before.finished_at);
}

TEST_P(StoreConformance, PagesGoFromTheNewestToTheOldestWithoutGapsOrRepeats) {
    for (int i = 0; i < 7; i++) accept(job("job" + std::to_string(i)));
    JobQuery query;
    query.limit = 3;
    std::string seen;
    bool more = true;
    while (more) {
        const JobPage page = store_->list(query);
        EXPECT_LE(page.jobs.size(), 3U);
        for (const JobSummary& summary : page.jobs) seen += summary.id.back();
        query.before_seq = page.jobs.back().seq;
        more = page.more;
    }
    EXPECT_EQ(seen, "6543210");
}

TEST_P(StoreConformance, ListsFilterByStatusAndByName) {
    for (const char* id : {"a", "b", "c"}) accept(job(id));
    claim();
    JobQuery running;
    running.status = JobStatus::running;
    ASSERT_EQ(store_->list(running).jobs.size(), 1U);
    EXPECT_EQ(store_->list(running).jobs.front().id, "a");
    JobQuery named;
    named.name = "name of b";
    ASSERT_EQ(store_->list(named).jobs.size(), 1U);
    EXPECT_EQ(store_->list(named).jobs.front().id, "b");
    named.status = JobStatus::running;
    EXPECT_TRUE(store_->list(named).jobs.empty());
}

}  // namespace tunewright::server
