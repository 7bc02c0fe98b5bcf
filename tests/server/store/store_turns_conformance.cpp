// The order of claims: flows take turns, jobs of low priority and entries of batches come after the others; no claim
// succeeds while the queue is paused.
#include "tests/server/store/store_conformance.h"

namespace tunewright::server {
namespace {

using testing::ElementsAre;

TEST_P(StoreConformance, AFlowWithOneJobDoesNotWaitForThatWithAThousand) {
    for (int i = 0; i < 1000; i++)
        store_->accept(job("many" + std::to_string(i), "many"), [](const Outcome<Accepted>&) {});
    accept(job("one", "one"));
    Ids ids;
    for (int i = 0; i < 3; i++) ids.push_back(claim().value().id);
    EXPECT_THAT(ids, testing::Contains("one"));
}

TEST_P(StoreConformance, FlowsTakeTurnsOneJobEach) {
    for (const char* id : {"a1", "a2", "a3", "a4"}) accept(job(id, "a"));
    for (const char* id : {"b1", "b2"}) accept(job(id, "b"));
    accept(job("c1", "c"));
    EXPECT_THAT(claim_all(), ElementsAre("a1", "b1", "c1", "a2", "b2", "a3", "a4"));
}

TEST_P(StoreConformance, AFlowThatPostsOneAfterAnotherSharesWithOneThatPostedAll) {
    for (int i = 0; i < 50; i++) accept(job("many" + std::to_string(i), "many"));
    int of_many = 0;
    for (int i = 0; i < 10; i++) {
        const std::string id = "one" + std::to_string(i);
        accept(job(id, "one"));
        for (auto next = claim(); next->id != id; next = claim()) {
            of_many++;
            finish(next->id, JobStatus::succeeded, "{}");
        }
        finish(id, JobStatus::succeeded, "{}");
    }
    EXPECT_GE(of_many, 8) << "it must not push the others aside";
    EXPECT_LE(of_many, 12) << "nor wait behind them";
}

TEST_P(StoreConformance, AReleasedJobKeepsItsPlace) {
    for (const char* id : {"a1", "a2", "a3"}) accept(job(id, "a"));
    EXPECT_EQ(claim().value().id, "a1");
    accept(job("b1", "b"));
    release("a1");
    EXPECT_EQ(claim().value().id, "a1");
}

TEST_P(StoreConformance, SingleJobsGoBeforeEntries) {
    make_batch("batch", 3, "a");
    EXPECT_EQ(claim().value().id, "batch-0");
    accept(job("single1", "a"));
    accept(job("single2", "b"));
    EXPECT_THAT(claim_all(), ElementsAre("single1", "single2", "batch-1", "batch-2"));
}

TEST_P(StoreConformance, BatchesOfDifferentFlowsTakeTurns) {
    make_batch("x", 3, "a");
    make_batch("y", 2, "b");
    EXPECT_THAT(claim_all(), ElementsAre("x-0", "y-0", "x-1", "y-1", "x-2"));
}

TEST_P(StoreConformance, BatchesOfOneFlowFollowEachOther) {
    make_batch("x", 2, "a");
    make_batch("y", 2, "a");
    EXPECT_THAT(claim_all(), ElementsAre("x-0", "x-1", "y-0", "y-1"));
}

TEST_P(StoreConformance, JobsOfLowPriorityComeAfterTheOthersAndAreSingleJobsAllTheSame) {
    NewJob low = low_job("low");
    low.created_at = 900;
    accept(low);
    accept(job("normal"));
    EXPECT_EQ(store_->depth().single, 2U);
    EXPECT_EQ(store_->depth().entries, 0U);
    EXPECT_EQ(store_->depth().next_single, 1000);
    EXPECT_EQ(store_->depth().next_entry, 900) << "the next of the class that they share with entries";
    JobQuery queued;
    queued.status = JobStatus::queued;
    EXPECT_EQ(store_->list(queued).jobs.size(), 2U);
    EXPECT_THAT(claim_all(), ElementsAre("normal", "low"));
    EXPECT_TRUE(finish("low", JobStatus::succeeded, "{}"));
    EXPECT_EQ(remove("low"), RemoveEffect::removed);
}

TEST_P(StoreConformance, JobsOfLowPriorityTakeTurnsWithEntries) {
    make_batch("x", 3, "a");
    for (const char* id : {"low1", "low2"}) accept(low_job(id, "b"));
    EXPECT_THAT(claim_all(), ElementsAre("x-0", "low1", "x-1", "low2", "x-2"));
}

TEST_P(StoreConformance, AReleasedJobOfLowPriorityKeepsItsPlaceToo) {
    for (const char* id : {"low1", "low2"}) accept(low_job(id));
    EXPECT_EQ(claim().value().id, "low1");
    accept(job("normal"));
    release("low1");
    EXPECT_THAT(claim_all(), ElementsAre("normal", "low1", "low2"));
}

TEST_P(StoreConformance, AClaimMayAskForTheLowClassFirst) {
    for (const char* id : {"normal1", "normal2"}) accept(job(id));
    accept(low_job("low", "a"));
    make_batch("x", 1, "b");
    const auto low_first = [&] {
        const auto claimed = claim_by({"worker", now(), kAlive, 1, false, true});
        return claimed.empty() ? std::string("none") : claimed[0].id;
    };
    EXPECT_EQ(low_first(), "low");
    EXPECT_EQ(claim().value().id, "normal1");
    EXPECT_EQ(low_first(), "x-0");
    EXPECT_EQ(batch("x").running, 1U);
    EXPECT_EQ(low_first(), "normal2") << "where none is low the others need not wait";
    EXPECT_EQ(low_first(), "none");
}

TEST_P(StoreConformance, WhileTheQueueIsPausedNothingIsHandedOutAndAllElseGoesOn) {
    for (const char* id : {"running", "released", "waiting"}) accept(job(id));
    make_batch("x", 1);
    claim_many(2);
    EXPECT_FALSE(store_->depth().paused);
    pause(true);
    pause(true);
    EXPECT_TRUE(store_->depth().paused);
    EXPECT_FALSE(claim());
    EXPECT_TRUE(claim_by({"worker", now(), kAlive, 5, false, true}).empty());
    EXPECT_EQ(accept(job("new")).kind, Accepted::Kind::created);
    EXPECT_TRUE(finish("running", JobStatus::succeeded, "{}"));
    EXPECT_TRUE(release("released"));
    EXPECT_EQ(cancel("waiting"), CancelEffect::cancelled);
    EXPECT_EQ(waiting(), 3U);
    EXPECT_FALSE(claim());
    pause(false);
    EXPECT_FALSE(store_->depth().paused);
    EXPECT_THAT(claim_all(), ElementsAre("released", "new", "x-0"));
}

TEST_P(StoreConformance, APauseLastsUntilSomebodyEndsIt) {
    accept(job("a"));
    pause(true);
    reopen();
    EXPECT_TRUE(store_->depth().paused);
    EXPECT_FALSE(claim());
    pause(false);
    reopen();
    EXPECT_FALSE(store_->depth().paused);
    EXPECT_TRUE(claim());
}

}  // namespace
}  // namespace tunewright::server
