// Ended jobs are deleted after their retention: single jobs by their state, batches as a whole.
#include <limits>

#include "tests/server/store/store_conformance.h"

namespace tunewright::server {
namespace {

using namespace std::chrono_literals;

constexpr UnixMs kEver = std::numeric_limits<UnixMs>::max() / 2;
/// More entries than any store deletes in one piece.
constexpr std::int64_t kLarge = 1300;

TEST_P(StoreConformance, SweepingTakesWhatEndedBeforeAndNothingElse) {
    for (const char* id : {"old", "older", "running", "waiting"}) accept(job(id));
    for (int i = 0; i < 3; i++) claim();
    finish("old", JobStatus::succeeded, "{}");
    finish("older", JobStatus::failed, "", "{}");
    EXPECT_EQ(sweep(3000, 10), 0U) << "both ended at 3000";
    EXPECT_EQ(sweep(3001, 1), 1U);
    EXPECT_EQ(sweep(3001, 10), 1U);
    EXPECT_EQ(sweep(kEver, 10), 0U);
    EXPECT_FALSE(store_->find("old"));
    EXPECT_FALSE(store_->find("older"));
    EXPECT_EQ(status("running"), JobStatus::running);
    EXPECT_EQ(status("waiting"), JobStatus::queued);
}

TEST_P(StoreConformance, WhatHasEndedIsKeptAsLongAsItsState) {
    for (const char* id : {"succeeded", "failed", "cancelled"}) accept(job(id));
    claim_many(2);
    finish("succeeded", JobStatus::succeeded, "{}");
    finish("failed", JobStatus::failed, "", "{}");
    cancel("cancelled");
    const Retention retention{1s, 5s, std::nullopt};
    EXPECT_EQ(sweep(4000, retention), 0U);
    EXPECT_EQ(sweep(4001, retention), 1U);
    EXPECT_FALSE(store_->find("succeeded"));
    EXPECT_EQ(sweep(8000, retention), 0U);
    EXPECT_EQ(sweep(8001, retention), 1U);
    EXPECT_FALSE(store_->find("failed"));
    EXPECT_EQ(sweep(kEver, retention), 0U);
    EXPECT_EQ(status("cancelled"), JobStatus::cancelled);
    EXPECT_EQ(sweep(kEver, {std::nullopt, std::nullopt, 1s}), 1U);
}

TEST_P(StoreConformance, WithoutARetentionNothingIsSwept) {
    accept(job("a"));
    cancel("a");
    make_batch("x", 0);
    EXPECT_EQ(sweep(kEver, Retention{}), 0U);
    EXPECT_TRUE(store_->find("a"));
    EXPECT_TRUE(store_->find_batch("x"));
}

TEST_P(StoreConformance, ABatchIsKeptAsLongAsAnyOfItsJobsMightBe) {
    make_batch({"x", "", "", "", 1000}, 3);
    claim_many(2);
    finish("x-0", JobStatus::succeeded, "{}");
    finish("x-1", JobStatus::failed, "", "{}");
    cancel("x-2");
    EXPECT_EQ(batch("x").finished_at, 3000);
    accept(job("single"));
    claim();
    finish("single", JobStatus::succeeded, "{}");
    EXPECT_EQ(sweep(kEver, {1s, 2s, std::nullopt}), 1U) << "the single job";
    EXPECT_EQ(sweep(8000, {1s, 2s, 5s}), 0U);
    EXPECT_TRUE(store_->find("x-0"));
    EXPECT_EQ(sweep(8001, {1s, 2s, 5s}), 3U);
    EXPECT_FALSE(store_->find_batch("x"));
    EXPECT_FALSE(store_->find("x-0"));
}

TEST_P(StoreConformance, ABatchThatGoesOnIsNotSweptHoweverOldItIs) {
    make_batch({"queued", "", "", "", 1000}, 2);
    make_batch({"running", "", "", "", 1000}, 1);
    claim_many(3);
    finish("queued-0", JobStatus::succeeded, "{}");
    release("queued-1");
    EXPECT_EQ(sweep(kEver, 10), 0U);
    EXPECT_EQ(status("queued-0"), JobStatus::succeeded);
    finish("running-0", JobStatus::succeeded, "{}");
    EXPECT_EQ(sweep(kEver, 10), 1U);
    EXPECT_FALSE(store_->find_batch("running"));
    EXPECT_TRUE(store_->find_batch("queued"));
}

TEST_P(StoreConformance, SweepingTakesEndedBatchesAndCountsTheirJobs) {
    make_batch("x", kLarge);
    make_batch("running", 2);
    open_batch("receiving");
    cancel_batch("x");
    claim();
    accept(job("single"));
    cancel("single");
    EXPECT_EQ(sweep(1000, 10), 0U);
    const UnixMs later = now() + 1000;
    EXPECT_EQ(sweep(later, 100), 100U);
    EXPECT_FALSE(store_->find_batch("x")) << "a batch is not shown in part";
    std::size_t gone = 100;
    for (std::size_t last = 100; last == 100;) gone += last = sweep(later, 100);
    EXPECT_EQ(gone, static_cast<std::size_t>(kLarge) + 1);
    EXPECT_EQ(sweep(later, 100), 0U);
    EXPECT_TRUE(store_->find_batch("running"));
    EXPECT_TRUE(store_->find_batch("receiving"));
    EXPECT_FALSE(store_->find("x-7"));
    EXPECT_FALSE(store_->find("single"));
}

}  // namespace
}  // namespace tunewright::server
