// Jobs held by a worker: attempts as fencing tokens, and jobs whose worker is gone or returns them.
#include <thread>

#include "tests/server/store/store_conformance.h"

namespace tunewright::server {
namespace {

TEST_P(StoreConformance, CancellingARunningJobIsRememberedUntilItEnds) {
    accept(job("a"));
    claim(kDead);
    EXPECT_EQ(cancel("a"), CancelEffect::requested);
    EXPECT_EQ(status("a"), JobStatus::running);
    EXPECT_TRUE(store_->find("a").value().cancel_requested);
    const Recovery recovery = reopen();
    EXPECT_EQ(waiting(), 0U);
    EXPECT_EQ(status("a"), JobStatus::cancelled);
}

TEST_P(StoreConformance, AnInterruptedJobIsQueuedBeforeLaterOnesAndCountsItsAttempts) {
    accept(job("a"));
    accept(job("b"));
    claim(kDead);
    const Recovery recovery = reopen();
    EXPECT_EQ(recovery.interrupted, 1U);
    EXPECT_EQ(waiting(), 2U);
    const JobRecord claimed = claim().value();
    EXPECT_EQ(claimed.id, "a");
    EXPECT_EQ(claimed.attempts, 2);
}

TEST_P(StoreConformance, AJobThatWasInterruptedTooOftenFails) {
    accept(job("a"));
    claim(kDead);
    reopen(2);
    claim(kDead);
    const Recovery recovery = reopen(2, kIn2096);
    EXPECT_EQ(recovery.given_up, 1U);
    EXPECT_EQ(waiting(), 0U);
    const JobRecord found = store_->find("a").value();
    EXPECT_EQ(found.status, JobStatus::failed);
    EXPECT_EQ(found.error, R"({"type":"given-up"})");
    EXPECT_EQ(found.finished_at, kIn2096);
}

TEST_P(StoreConformance, GivingAJobBackIsNoCrash) {
    accept(job("a"));
    for (int attempt = 1; attempt <= 5; attempt++) {
        ASSERT_TRUE(claim());
        EXPECT_TRUE(release("a", attempt));
    }
    claim(kDead, "dead");
    EXPECT_EQ(reclaim(2).given_up, 0U) << "six claims, and one crash";
    EXPECT_EQ(status("a"), JobStatus::queued);
}

TEST_P(StoreConformance, AJobThatHasCrashedTwiceWaitsAWhileAndIsClaimedByItself) {
    for (const char* id : {"a", "b"}) accept(job(id));
    for (int i = 0; i < 2; i++) {
        ASSERT_EQ(claim(kDead).value().id, "a");
        EXPECT_EQ(reclaim().interrupted, 1U);
    }
    EXPECT_EQ(store_->depth().single, 2U);
    const auto usual = claim_many(5);
    ASSERT_EQ(usual.size(), 1U);
    EXPECT_EQ(usual[0].id, "b");
    const auto suspects = [&] { return claim_by({"worker", now(), kAlive, 5, true}); };
    EXPECT_TRUE(suspects().empty()) << "its pause is not over";
    EXPECT_EQ(store_->depth().suspects, 0U);
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    EXPECT_EQ(store_->depth().suspects, 1U);
    pause(true);
    EXPECT_TRUE(suspects().empty());
    pause(false);
    const auto alone = suspects();
    ASSERT_EQ(alone.size(), 1U);
    EXPECT_EQ(alone[0].id, "a");
    EXPECT_EQ(alone[0].attempts, 3);
    EXPECT_EQ(store_->depth().suspects, 0U);
}

TEST_P(StoreConformance, AReleasedJobIsQueuedAgain) {
    accept(job("a"));
    EXPECT_FALSE(release("a"));
    claim();
    EXPECT_TRUE(store_->find("a").value().started_at);
    EXPECT_TRUE(release("a"));
    const JobRecord found = store_->find("a").value();
    EXPECT_EQ(found.status, JobStatus::queued);
    EXPECT_EQ(found.attempts, 1);
    EXPECT_FALSE(found.started_at) << "that was of an attempt which came to nothing";
    EXPECT_EQ(claim().value().attempts, 2);
}

TEST_P(StoreConformance, TwoWorkersGetDifferentJobs) {
    for (const char* id : {"a", "b", "c"}) accept(job(id));
    EXPECT_EQ(claim(kAlive, "one").value().id, "a");
    EXPECT_EQ(claim(kAlive, "two").value().id, "b");
    EXPECT_EQ(claim(kAlive, "one").value().id, "c");
    EXPECT_FALSE(claim(kAlive, "two"));
}

TEST_P(StoreConformance, AClaimGivesAsManyAsAskedForInTheirOrder) {
    for (const char* id : {"a", "b", "c"}) accept(job(id));
    const auto two = claim_many(2);
    ASSERT_EQ(two.size(), 2U);
    EXPECT_EQ(two[0].id, "a");
    EXPECT_EQ(two[1].id, "b");
    EXPECT_EQ(two[1].request, job("b").request);
    EXPECT_EQ(claim_many(2).size(), 1U);
    EXPECT_TRUE(claim_many(2).empty());
}

TEST_P(StoreConformance, ALeaseThatIsOverIsReclaimedAndOneThatIsNotStays) {
    for (const char* id : {"dead", "alive", "waiting"}) accept(job(id));
    claim(kDead, "one");
    claim(kAlive, "another");
    const Recovery recovery = reclaim();
    EXPECT_EQ(recovery.interrupted, 1U);
    EXPECT_EQ(recovery.given_up, 0U);
    EXPECT_EQ(waiting(), 2U);
    EXPECT_TRUE(recovery.ended.empty());
    EXPECT_EQ(status("dead"), JobStatus::queued);
    EXPECT_FALSE(store_->find("dead").value().started_at);
    EXPECT_EQ(status("alive"), JobStatus::running);
    const JobRecord again = claim().value();
    EXPECT_EQ(again.id, "dead") << "at its old place";
    EXPECT_EQ(again.attempts, 2);
}

TEST_P(StoreConformance, AllJobsOfADeadWorkerWaitAgain) {
    for (const char* id : {"a", "b", "c"}) accept(job(id));
    claim_many(3, kDead);
    EXPECT_EQ(reclaim().interrupted, 3U);
    EXPECT_EQ(reclaim().interrupted, 0U) << "a crash is counted once";
    EXPECT_THAT(claim_all(), testing::ElementsAre("a", "b", "c"));
}

TEST_P(StoreConformance, AWorkerThatWasThoughtDeadCanNeitherEndTheJobNorReleaseIt) {
    accept(job("a"));
    claim(kDead, "first");
    reclaim();
    EXPECT_FALSE(finish("a", JobStatus::succeeded, "{}", "", 1)) << "nobody has it now";
    EXPECT_FALSE(release("a", 1));
    ASSERT_EQ(claim(kAlive, "second").value().attempts, 2);
    EXPECT_FALSE(finish("a", JobStatus::succeeded, R"({"from":"the first"})", "", 1));
    EXPECT_FALSE(release("a", 1));
    EXPECT_THAT(holdings("first"), testing::IsEmpty());
    EXPECT_EQ(status("a"), JobStatus::running);
    EXPECT_TRUE(finish("a", JobStatus::succeeded, R"({"from":"the second"})", "", 2));
    EXPECT_EQ(store_->find("a").value().result, R"({"from":"the second"})");
}

TEST_P(StoreConformance, AJobReclaimedTooOftenFailsWithItsReason) {
    accept(job("a"));
    claim(kDead);
    EXPECT_EQ(reclaim(2).given_up, 0U);
    claim(kDead);
    const Recovery recovery = reclaim(2);
    EXPECT_EQ(recovery.given_up, 1U);
    EXPECT_EQ(recovery.interrupted, 0U);
    EXPECT_THAT(recovery.ended, testing::ElementsAre("a"));
    EXPECT_EQ(status("a"), JobStatus::failed);
    EXPECT_EQ(store_->find("a").value().error, kGivenUp);
    EXPECT_TRUE(store_->find("a").value().finished_at);
    EXPECT_FALSE(claim());
}

TEST_P(StoreConformance, AnInterruptedJobWhoseCancelWasAskedForIsCancelledInsteadOfQueued) {
    accept(job("a"));
    claim(kDead);
    cancel("a");
    const Recovery recovery = reclaim(1);
    EXPECT_EQ(recovery.given_up, 0U);
    EXPECT_THAT(recovery.ended, testing::ElementsAre("a"));
    EXPECT_EQ(status("a"), JobStatus::cancelled);
    EXPECT_FALSE(claim());
}

TEST_P(StoreConformance, AReleasedJobWhoseCancelWasAskedForIsCancelledInsteadOfQueued) {
    accept(job("a"));
    claim();
    cancel("a");
    EXPECT_TRUE(release("a"));
    EXPECT_EQ(status("a"), JobStatus::cancelled);
    EXPECT_TRUE(store_->find("a").value().finished_at);
    EXPECT_FALSE(claim());
}

TEST_P(StoreConformance, OfManyEndsOfOneJobOneCounts) {
    accept(job("a"));
    claim();
    std::vector<std::promise<bool>> ends(20);
    JobEnd end = end_of("a", JobStatus::succeeded, "");
    for (std::size_t i = 0; i < ends.size(); i++) {
        end.result = "{\"n\":" + std::to_string(i) + "}";
        store_->finish(end, [&ends, i](const Outcome<bool>& outcome) { ends[i].set_value(std::get<bool>(outcome)); });
    }
    int counted = 0;
    for (auto& counts : ends) counted += counts.get_future().get() ? 1 : 0;
    EXPECT_EQ(counted, 1);
    EXPECT_EQ(store_->find("a").value().result, R"({"n":0})");
}

}  // namespace
}  // namespace tunewright::server
