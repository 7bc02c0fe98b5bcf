// Jobs that a worker has: leases, attempts as fencing tokens, what becomes of a job whose worker is gone.
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
    const Recovery recovery = reopen(2);
    EXPECT_EQ(recovery.given_up, 1U);
    EXPECT_EQ(waiting(), 0U);
    const JobRecord found = store_->find("a").value();
    EXPECT_EQ(found.status, JobStatus::failed);
    EXPECT_EQ(found.error, R"({"type":"given-up"})");
    EXPECT_EQ(found.finished_at, 9000);
}

TEST_P(StoreConformance, GivingAJobBackIsNoCrash) {
    accept(job("a"));
    for (int attempt = 1; attempt <= 5; attempt++) {
        ASSERT_TRUE(claim());
        EXPECT_TRUE(release("a", attempt));
    }
    claim(kDead);
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
    const auto suspects = [&] {
        const Claim claim{"worker", now(), kAlive, 5, true};
        return completed<std::vector<JobRecord>>([&](auto done) { store_->claim(claim, done); });
    };
    EXPECT_TRUE(suspects().empty()) << "its pause is not over";
    std::this_thread::sleep_for(std::chrono::milliseconds(1100));
    EXPECT_EQ(store_->depth().suspects, 1U);
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
    EXPECT_TRUE(release("a"));
    EXPECT_EQ(status("a"), JobStatus::queued);
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
    claim(kDead);
    claim(kAlive);
    const Recovery recovery = reclaim();
    EXPECT_EQ(recovery.interrupted, 1U);
    EXPECT_EQ(recovery.given_up, 0U);
    EXPECT_EQ(waiting(), 2U);
    EXPECT_TRUE(recovery.ended.empty());
    EXPECT_EQ(status("dead"), JobStatus::queued);
    EXPECT_EQ(status("alive"), JobStatus::running);
    const JobRecord again = claim().value();
    EXPECT_EQ(again.id, "dead") << "at its old place";
    EXPECT_EQ(again.attempts, 2);
}

TEST_P(StoreConformance, ARenewedLeaseIsNotReclaimed) {
    accept(job("a"));
    claim(kDead);
    const auto renewed = renew({{"a", 1, ""}}, kAlive);
    ASSERT_EQ(renewed.size(), 1U);
    EXPECT_EQ(renewed[0].id, "a");
    EXPECT_TRUE(renewed[0].held);
    EXPECT_FALSE(renewed[0].cancel_requested);
    EXPECT_EQ(reclaim().interrupted, 0U);
    EXPECT_EQ(status("a"), JobStatus::running);
}

TEST_P(StoreConformance, AWorkerThatWasThoughtDeadCannotEndReleaseOrRenewTheJob) {
    accept(job("a"));
    claim(kDead);
    reclaim();
    EXPECT_FALSE(finish("a", JobStatus::succeeded, "{}", "", 1)) << "nobody has it now";
    ASSERT_EQ(claim(kAlive, "another").value().attempts, 2);
    EXPECT_FALSE(finish("a", JobStatus::succeeded, R"({"from":"the first"})", "", 1));
    EXPECT_FALSE(release("a", 1));
    EXPECT_FALSE(renew({{"a", 1, "{}"}})[0].held);
    EXPECT_EQ(status("a"), JobStatus::running);
    EXPECT_EQ(store_->find("a").value().progress, "");
    EXPECT_TRUE(finish("a", JobStatus::succeeded, R"({"from":"the second"})", "", 2));
    EXPECT_EQ(store_->find("a").value().result, R"({"from":"the second"})");
    EXPECT_FALSE(renew({{"a", 2, ""}})[0].held) << "it has ended";
}

TEST_P(StoreConformance, RenewalsAreAnsweredInTheirOrder) {
    for (const char* id : {"a", "b", "c"}) accept(job(id));
    claim_many(2);
    cancel("b");
    const auto renewed = renew({{"nobody", 1, ""}, {"b", 1, ""}, {"c", 1, ""}, {"a", 1, ""}});
    ASSERT_EQ(renewed.size(), 4U);
    EXPECT_FALSE(renewed[0].held);
    EXPECT_EQ(renewed[1].id, "b");
    EXPECT_TRUE(renewed[1].held);
    EXPECT_TRUE(renewed[1].cancel_requested);
    EXPECT_FALSE(renewed[2].held) << "it waits";
    EXPECT_TRUE(renewed[3].held);
    EXPECT_FALSE(renewed[3].cancel_requested);
}

TEST_P(StoreConformance, ProgressIsThatOfThePresentAttempt) {
    accept(job("a"));
    claim(kDead);
    EXPECT_EQ(store_->find("a").value().progress, "");
    renew({{"a", 1, R"({"stage":"one"})"}}, kDead);
    EXPECT_EQ(store_->find("a").value().progress, R"({"stage":"one"})");
    renew({{"a", 1, R"({"stage":"two"})"}}, kDead);
    renew({{"a", 1, ""}}, kDead);
    EXPECT_EQ(store_->states({"a"}).at(0).progress, R"({"stage":"two"})") << "an empty one leaves what is there";
    reclaim();
    claim();
    EXPECT_EQ(store_->find("a").value().progress, "") << "that was of the attempt before";
    EXPECT_EQ(store_->states({"a"}).at(0).progress, "");
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
    for (std::size_t i = 0; i < ends.size(); i++)
        store_->finish({"a", 1, JobStatus::succeeded, "{\"n\":" + std::to_string(i) + "}", "", "1", 3000},
                       [&ends, i](const Outcome<bool>& outcome) { ends[i].set_value(std::get<bool>(outcome)); });
    int counted = 0;
    for (auto& end : ends) counted += end.get_future().get() ? 1 : 0;
    EXPECT_EQ(counted, 1);
    EXPECT_EQ(store_->find("a").value().result, R"({"n":0})");
}

}  // namespace
}  // namespace tunewright::server
