// Jobs that failed or were cancelled and are queued again: single ones, and entries with the counts of their batch.
#include "tests/server/store/store_conformance.h"

namespace tunewright::server {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST_P(StoreConformance, AFailedJobThatIsQueuedAgainIsAsIfItHadJustCome) {
    for (const char* id : {"a", "b"}) accept(job(id));
    claim();
    JobEnd end = end_of("a", JobStatus::failed, R"({"partial":true})", R"({"type":"timeout"})");
    end.outline = R"({"method":"simc"})";
    EXPECT_TRUE(finish(end));
    EXPECT_EQ(requeue("a"), RequeueEffect::requeued);
    const JobRecord found = store_->find("a").value();
    EXPECT_EQ(found.status, JobStatus::queued);
    EXPECT_EQ(found.attempts, 1) << "they go on counting";
    EXPECT_EQ(found.request, job("a").request);
    EXPECT_EQ(found.created_at, 1000);
    EXPECT_EQ(found.result + found.error + found.outline, "");
    EXPECT_FALSE(found.started_at || found.finished_at);
    EXPECT_EQ(store_->depth().single, 2U);
    EXPECT_THAT(claim_all(), ElementsAre("b", "a")) << "behind those that its flow has posted meanwhile";
    EXPECT_FALSE(finish(end)) << "the attempt of then cannot end it";
    EXPECT_TRUE(finish("a", JobStatus::succeeded, R"({"x":1})", "", 2));
    EXPECT_EQ(store_->find("a").value().result, R"({"x":1})");
}

TEST_P(StoreConformance, ACancelledJobThatIsQueuedAgainIsNoLongerUnwanted) {
    for (const char* id : {"waited", "ran"}) accept(job(id));
    EXPECT_EQ(cancel("waited"), CancelEffect::cancelled);
    ASSERT_EQ(claim().value().id, "ran");
    EXPECT_EQ(cancel("ran"), CancelEffect::requested);
    EXPECT_TRUE(finish("ran", JobStatus::cancelled, R"({"partial":true})"));
    for (const char* id : {"waited", "ran"}) {
        EXPECT_EQ(requeue(id), RequeueEffect::requeued);
        EXPECT_FALSE(store_->find(id).value().cancel_requested);
    }
    EXPECT_EQ(claim().value().attempts, 1) << "the one that only waited";
    EXPECT_EQ(claim().value().attempts, 2);
    EXPECT_FALSE(holding("ran").value().cancel_requested);
    EXPECT_TRUE(release("waited", 1));
    EXPECT_TRUE(release("ran", 2));
    EXPECT_EQ(status("waited"), JobStatus::queued);
    EXPECT_EQ(status("ran"), JobStatus::queued);
}

TEST_P(StoreConformance, AJobThatWasGivenUpMayBeTriedAgainAndItsCrashesAreForgotten) {
    accept(job("a"));
    claim(kDead);
    EXPECT_EQ(reclaim(1).given_up, 1U);
    EXPECT_EQ(requeue("a"), RequeueEffect::requeued);
    ASSERT_EQ(claim(kDead).value().attempts, 2);
    const Recovery recovery = reclaim(2);
    EXPECT_EQ(recovery.interrupted, 1U);
    EXPECT_EQ(recovery.given_up, 0U);
    EXPECT_EQ(claim().value().attempts, 3) << "one crash since then: it need not wait";
}

TEST_P(StoreConformance, OnlyWhatFailedOrWasCancelledIsQueuedAgain) {
    for (const char* id : {"succeeded", "running", "waiting"}) accept(job(id));
    claim_many(2);
    finish("succeeded", JobStatus::succeeded, R"({"x":1})");
    EXPECT_EQ(requeue("succeeded"), RequeueEffect::not_failed);
    EXPECT_EQ(requeue("running"), RequeueEffect::not_failed);
    EXPECT_EQ(requeue("waiting"), RequeueEffect::not_failed);
    EXPECT_EQ(requeue("nobody"), RequeueEffect::none);
    EXPECT_EQ(store_->find("succeeded").value().result, R"({"x":1})");
    EXPECT_EQ(status("running"), JobStatus::running);
    EXPECT_THAT(claim_all(), ElementsAre("waiting"));
}

TEST_P(StoreConformance, OfManyRequeuesOfOneJobOneCounts) {
    accept(job("a"));
    cancel("a");
    std::vector<std::promise<RequeueEffect>> answers(20);
    for (std::size_t i = 0; i < answers.size(); i++)
        store_->requeue("a", [&answers, i](const Outcome<RequeueEffect>& outcome) {
            answers[i].set_value(std::get<RequeueEffect>(outcome));
        });
    int requeued = 0;
    for (auto& answer : answers) requeued += answer.get_future().get() == RequeueEffect::requeued ? 1 : 0;
    EXPECT_EQ(requeued, 1);
    EXPECT_EQ(waiting(), 1U);
    EXPECT_THAT(claim_all(), ElementsAre("a"));
}

TEST_P(StoreConformance, WhatIsQueuedAgainKeepsItsKeyAndItsPriority) {
    NewJob made = low_job("low");
    made.idempotency_key = "key";
    accept(made);
    cancel("low");
    accept(job("normal"));
    EXPECT_EQ(requeue("low"), RequeueEffect::requeued);
    EXPECT_EQ(accept(made).job.id, "low");
    EXPECT_THAT(claim_all(), ElementsAre("normal", "low"));
}

TEST_P(StoreConformance, WhatIsQueuedAgainMayEndAndGoAsAnyOtherJob) {
    accept(job("a"));
    for (int i = 0; i < 3; i++) {
        EXPECT_EQ(cancel("a"), CancelEffect::cancelled);
        EXPECT_EQ(cancel("a"), CancelEffect::ended);
        EXPECT_EQ(requeue("a"), RequeueEffect::requeued);
        EXPECT_EQ(remove("a"), RemoveEffect::not_ended);
        EXPECT_EQ(sweep(soon(), 10), 0U);
    }
    cancel("a");
    EXPECT_EQ(remove("a"), RemoveEffect::removed);
    EXPECT_EQ(requeue("a"), RequeueEffect::none);
}

TEST_P(StoreConformance, AnEntryThatIsQueuedAgainOpensItsBatch) {
    make_batch({"x", "", "", "", 1000}, 4);
    claim_many(3);
    finish("x-0", JobStatus::succeeded, "{}");
    finish("x-1", JobStatus::failed, "", R"({"type":"e"})");
    finish("x-2", JobStatus::cancelled, "");
    cancel("x-3");
    reclaim();  // which settles it
    ASSERT_TRUE(batch("x").ended());
    for (const char* id : {"x-1", "x-3"}) EXPECT_EQ(requeue(id), RequeueEffect::requeued);
    BatchSummary counts = batch("x");
    EXPECT_FALSE(counts.ended());
    EXPECT_FALSE(counts.finished_at);
    EXPECT_EQ(counts.total, 4U);
    EXPECT_EQ(counts.queued, 2U);
    EXPECT_EQ(counts.succeeded, 1U);
    EXPECT_EQ(counts.failed, 0U);
    EXPECT_EQ(counts.cancelled, 1U);
    EXPECT_EQ(store_->depth().entries, 2U);
    EXPECT_EQ(store_->batch_rows("x", 1, 1).at(0).error, "");
    EXPECT_EQ(remove_batch("x"), RemoveEffect::not_ended);
    EXPECT_EQ(sweep(soon(), 10), 0U);
    EXPECT_EQ(reclaim().interrupted, 0U);
    EXPECT_THAT(claim_all(), ElementsAre("x-1", "x-3"));
    EXPECT_EQ(batch("x").running, 2U);
    finish("x-1", JobStatus::succeeded, "{}", "", 2, 4000);
    finish("x-3", JobStatus::succeeded, "{}", "", 1, 5000);
    counts = batch("x");
    EXPECT_TRUE(counts.ended());
    EXPECT_EQ(counts.succeeded, 3U);
    EXPECT_EQ(counts.finished_at, 5000);
    EXPECT_EQ(sweep(soon(), 10), 4U);
}

TEST_P(StoreConformance, EntriesOfACancelledBatchStayAsTheyAre) {
    make_batch("x", 3);
    claim_many(2);
    finish("x-0", JobStatus::failed, "", R"({"type":"e"})");
    cancel_batch("x");
    for (const char* id : {"x-0", "x-2"}) EXPECT_EQ(requeue(id), RequeueEffect::batch_cancelled) << id;
    EXPECT_EQ(requeue("x-1"), RequeueEffect::not_failed) << "it runs";
    EXPECT_EQ(batch("x").failed, 1U);
    EXPECT_EQ(batch("x").cancelled, 1U);
    EXPECT_EQ(status("x-0"), JobStatus::failed);
    EXPECT_FALSE(claim());
    drop("x");
    EXPECT_EQ(requeue("x-0"), RequeueEffect::none);
}

TEST_P(StoreConformance, AnEntryThatCouldNeverBeReadIsNotQueuedAgain) {
    open_batch("x");
    add_entries("x", {entry("x", 0, R"({"type":"bad"})"), entry("x", 1)});
    seal("x");
    EXPECT_EQ(requeue("x-0"), RequeueEffect::not_failed);
    EXPECT_EQ(store_->find("x-0").value().error, R"({"type":"bad"})");
    EXPECT_EQ(batch("x").failed, 1U);
    EXPECT_THAT(claim_all(), ElementsAre("x-1"));
    finish("x-1", JobStatus::failed, "", R"({"type":"e"})");
    EXPECT_EQ(requeue("x-1"), RequeueEffect::requeued);
    EXPECT_EQ(requeue("x-0"), RequeueEffect::not_failed);
    EXPECT_THAT(claim_all(), ElementsAre("x-1"));
    EXPECT_THAT(claim_all(), IsEmpty());
}

}  // namespace
}  // namespace tunewright::server
