// Batches: received, sealed, counted, read row by row, cancelled, dropped, removed.
#include "tests/server/store/store_conformance.h"

namespace tunewright::server {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;
using namespace std::chrono_literals;

/// More than any store processes in one piece.
constexpr std::int64_t kLarge = 1300;

TEST_P(StoreConformance, ABatchIsReceivedPieceByPieceAndItsEntriesAreJobs) {
    NewBatch made{"x", "name of x", "me", "flow", now()};
    made.origin = {"call 7", "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01"};
    open_batch(made);
    EXPECT_FALSE(batch("x").sealed);
    EXPECT_TRUE(add_waiting("x", 0, 2));
    EXPECT_TRUE(add_entries("x", {})) << "an empty piece";
    EXPECT_TRUE(add_waiting("x", 2, 1));
    const JobRecord claimed = claim().value();
    EXPECT_EQ(claimed.id, "x-0") << "before it is sealed";
    EXPECT_EQ(claimed.batch, "x");
    EXPECT_EQ(claimed.request_id, made.origin.request_id);
    EXPECT_EQ(seal("x").kind, Sealed::Kind::sealed);
    const BatchSummary found = batch("x");
    EXPECT_EQ(found.name, "name of x");
    EXPECT_EQ(found.owner, "me");
    EXPECT_TRUE(found.sealed);
    EXPECT_EQ(found.total, 3U);
    EXPECT_EQ(found.queued, 2U);
    EXPECT_EQ(found.running, 1U);
    EXPECT_FALSE(found.finished_at);
    const JobRecord entry = store_->find("x-1").value();
    EXPECT_EQ(entry.batch, "x");
    EXPECT_EQ(entry.index, 1);
    EXPECT_EQ(entry.owner, "me");
    EXPECT_EQ(entry.name, "name of x-1");
    EXPECT_EQ(entry.request, R"({"plant":"x-1"})");
    EXPECT_EQ(entry.status, JobStatus::queued);
    EXPECT_EQ(entry.request_id, made.origin.request_id) << "that of the call which posted the batch";
    EXPECT_EQ(entry.traceparent, made.origin.traceparent);
    EXPECT_FALSE(store_->find_batch("y"));
}

TEST_P(StoreConformance, ANameThatComesLateIsTheBatchs) {
    open_batch("x");
    EXPECT_EQ(seal("x", "", "hash", "late").kind, Sealed::Kind::sealed);
    EXPECT_EQ(batch("x").name, "late");
}

TEST_P(StoreConformance, ASealedBatchTakesNoMore) {
    make_batch("x", 1);
    EXPECT_FALSE(add_waiting("x", 1, 1));
    EXPECT_EQ(seal("x").kind, Sealed::Kind::none);
    EXPECT_FALSE(add_waiting("nobody", 0, 1));
    EXPECT_EQ(seal("nobody").kind, Sealed::Kind::none);
    EXPECT_EQ(batch("x").total, 1U);
}

TEST_P(StoreConformance, AnEntryThatCouldNotBeReadHasFailedFromTheStart) {
    open_batch("x");
    add_entries("x", {entry("x", 0), entry("x", 1, R"({"type":"bad"})"), entry("x", 2)});
    seal("x");
    EXPECT_EQ(batch("x").failed, 1U);
    EXPECT_EQ(batch("x").queued, 2U);
    const JobRecord bad = store_->find("x-1").value();
    EXPECT_EQ(bad.status, JobStatus::failed);
    EXPECT_EQ(bad.error, R"({"type":"bad"})");
    EXPECT_EQ(bad.request, "");
    EXPECT_EQ(bad.attempts, 0);
    EXPECT_TRUE(bad.finished_at);
    EXPECT_THAT(claim_all(), ElementsAre("x-0", "x-2"));
}

TEST_P(StoreConformance, CountsFollowItsEntriesToTheirEnds) {
    make_batch("x", 5);
    claim_many(4);
    finish("x-0", JobStatus::succeeded, R"({"n":0})");
    finish("x-1", JobStatus::failed, "", R"({"type":"e"})");
    finish("x-2", JobStatus::cancelled, R"({"partial":true})");
    release("x-3");
    BatchSummary counts = batch("x");
    EXPECT_EQ(counts.succeeded, 1U);
    EXPECT_EQ(counts.failed, 1U);
    EXPECT_EQ(counts.cancelled, 1U);
    EXPECT_EQ(counts.queued, 2U);
    EXPECT_EQ(counts.running, 0U);
    EXPECT_EQ(counts.total, 5U);
    EXPECT_FALSE(counts.ended());
    cancel("x-4");
    claim();
    finish("x-3", JobStatus::succeeded, "{}", "", 2);
    counts = batch("x");
    EXPECT_TRUE(counts.ended());
    EXPECT_EQ(counts.succeeded, 2U);
    EXPECT_EQ(counts.cancelled, 2U);
    EXPECT_GE(counts.finished_at.value(), 3000);
}

TEST_P(StoreConformance, ABatchWithoutEntriesHasEndedWhenItIsSealed) {
    make_batch("x", 0);
    EXPECT_TRUE(batch("x").ended());
    EXPECT_TRUE(batch("x").finished_at);
    EXPECT_EQ(batch("x").total, 0U);
    EXPECT_EQ(remove_batch("x"), RemoveEffect::removed);
}

TEST_P(StoreConformance, RowsComeInOrderAndPageByPage) {
    open_batch("x");
    add_waiting("x", 0, 3);
    add_entries("x", {entry("x", 3, R"({"type":"bad"})")});
    add_waiting("x", 4, 3);
    claim_many(2);
    finish("x-1", JobStatus::succeeded, R"({"n":1})");
    Ids ids;
    for (std::int64_t from = 0;;) {
        const auto rows = store_->batch_rows("x", from, 3);
        if (rows.empty()) break;
        EXPECT_LE(rows.size(), 3U);
        for (const BatchRow& row : rows) {
            EXPECT_EQ(row.index, static_cast<std::int64_t>(ids.size()));
            EXPECT_EQ(row.name, "name of " + row.id);
            ids.push_back(row.id);
        }
        from = rows.back().index + 1;
    }
    EXPECT_THAT(ids, ElementsAre("x-0", "x-1", "x-2", "x-3", "x-4", "x-5", "x-6"));
    const auto rows = store_->batch_rows("x", 0, 10);
    EXPECT_EQ(rows.at(0).status, JobStatus::running);
    EXPECT_EQ(rows.at(1).status, JobStatus::succeeded);
    EXPECT_EQ(rows.at(1).result, R"({"n":1})");
    EXPECT_EQ(rows.at(2).status, JobStatus::queued);
    EXPECT_EQ(rows.at(3).status, JobStatus::failed);
    EXPECT_EQ(rows.at(3).error, R"({"type":"bad"})");
    EXPECT_THAT(store_->batch_rows("nobody", 0, 10), IsEmpty());
}

TEST_P(StoreConformance, LongRowsComeFewAtATime) {
    open_batch("x");
    const std::string longest(BatchStore::kRowsBytes * 2 / 3, 'e');
    for (int i = 0; i < 4; i++) add_entries("x", {entry("x", i, longest)});
    EXPECT_EQ(store_->batch_rows("x", 0, 10).size(), 2U) << "the second goes beyond the bound";
    EXPECT_EQ(store_->batch_rows("x", 3, 10).size(), 1U);
    EXPECT_EQ(store_->batch_rows("x", 0, 1).size(), 1U);
    EXPECT_EQ(store_->batch_rows("x", 0, 10).at(1).error, longest);
}

TEST_P(StoreConformance, EntriesAreListedWithTheirBatchOnly) {
    accept(job("single"));
    make_batch("x", 5);
    make_batch("y", 1);
    ASSERT_EQ(store_->list({}).jobs.size(), 1U);
    EXPECT_EQ(store_->list({}).jobs[0].id, "single");
    JobQuery query;
    query.batch = "x";
    query.limit = 2;
    Ids ids;
    for (bool more = true; more;) {
        const JobPage page = store_->list(query);
        for (const JobSummary& summary : page.jobs) ids.push_back(summary.id);
        query.before_seq = page.jobs.back().seq;
        more = page.more;
    }
    EXPECT_THAT(ids, ElementsAre("x-4", "x-3", "x-2", "x-1", "x-0"));
    claim_many(2);
    query.before_seq.reset();
    query.limit = 10;
    query.status = JobStatus::queued;
    EXPECT_EQ(store_->list(query).jobs.size(), 4U) << "one claim was the single job's";
    query.batch = "nobody";
    EXPECT_THAT(store_->list(query).jobs, IsEmpty());
}

TEST_P(StoreConformance, AKeyFindsTheEarlierBatchUnlessItWasAnother) {
    open_batch("x", "me");
    add_waiting("x", 0, 2);
    EXPECT_FALSE(store_->batch_of_key("me", "key"));
    EXPECT_EQ(seal("x", "key", "hash").kind, Sealed::Kind::sealed);
    EXPECT_EQ(store_->batch_of_key("me", "key"), "x");
    EXPECT_FALSE(store_->batch_of_key("you", "key"));

    open_batch("again", "me");
    add_waiting("again", 0, 2);
    const Sealed same = seal("again", "key", "hash");
    EXPECT_EQ(same.kind, Sealed::Kind::existing);
    EXPECT_EQ(same.id, "x");
    EXPECT_FALSE(store_->find_batch("again")) << "it has been dropped";
    EXPECT_FALSE(store_->find("again-0"));

    open_batch("other", "me");
    EXPECT_EQ(seal("other", "key", "another hash").kind, Sealed::Kind::conflict);
    EXPECT_FALSE(store_->find_batch("other"));

    open_batch("yours", "you");
    EXPECT_EQ(seal("yours", "key", "another hash").kind, Sealed::Kind::sealed);
    EXPECT_THAT(claim_all(), ElementsAre("x-0", "x-1"));
}

TEST_P(StoreConformance, ADroppedBatchIsGoneWithEverythingOfIt) {
    open_batch("x");
    add_waiting("x", 0, kLarge);
    add_entries("x", {entry("x", kLarge, R"({"type":"bad"})")});
    claim();
    const JobEnd late = end_of("x-0", JobStatus::succeeded, "{}");
    make_batch("y", 1);
    EXPECT_TRUE(drop("x"));
    EXPECT_FALSE(drop("x"));
    EXPECT_FALSE(store_->find_batch("x"));
    EXPECT_FALSE(store_->find("x-0"));
    EXPECT_FALSE(store_->find("x-" + std::to_string(kLarge)));
    EXPECT_THAT(store_->states({"x-5"}), IsEmpty());
    EXPECT_THAT(store_->batch_rows("x", 0, 10), IsEmpty());
    EXPECT_THAT(beat(), IsEmpty()) << "who was at one of its entries learns it";
    EXPECT_FALSE(finish(late));
    EXPECT_FALSE(add_waiting("x", kLarge + 1, 1));
    EXPECT_EQ(store_->depth().entries, 1U);
    EXPECT_THAT(claim_all(), ElementsAre("y-0"));
}

TEST_P(StoreConformance, WhatIsLeftOfABatchThatIsBeingDroppedCountsNoMore) {
    open_batch("x");
    add_waiting("x", 0, kLarge);
    make_batch("y", 1);
    std::promise<void> dropped;
    store_->drop_batch("x", [&](const Outcome<bool>&) { dropped.set_value(); });
    // Its entries are deleted slice by slice, without reducing anybody's limit meanwhile.
    std::set<std::size_t> seen;
    for (auto end = dropped.get_future(); end.wait_for(0s) != std::future_status::ready;)
        seen.insert(store_->depth().entries);
    EXPECT_THAT(seen, testing::IsSubsetOf({std::size_t{1}, static_cast<std::size_t>(kLarge) + 1}));
    EXPECT_EQ(store_->depth().entries, 1U);
}

TEST_P(StoreConformance, CancellingABatchEndsWhatWaitsAndNamesWhatRuns) {
    make_batch("x", kLarge);
    make_batch("y", 1, "another flow");
    claim_many(3);
    finish("x-0", JobStatus::succeeded, "{}");
    const auto running = cancel_batch("x");
    ASSERT_TRUE(running);
    const bool y_was_claimed = status("y-0") == JobStatus::running;
    EXPECT_THAT(*running, y_was_claimed ? testing::Matcher<Ids>(ElementsAre("x-1"))
                                        : testing::Matcher<Ids>(UnorderedElementsAre("x-1", "x-2")));
    const BatchSummary counts = batch("x");
    EXPECT_TRUE(counts.cancel_requested);
    EXPECT_EQ(counts.succeeded, 1U);
    EXPECT_EQ(counts.queued, 0U);
    EXPECT_EQ(counts.running, running->size());
    EXPECT_EQ(counts.cancelled, static_cast<std::size_t>(kLarge) - 1 - running->size());
    EXPECT_EQ(status("x-0"), JobStatus::succeeded);
    EXPECT_TRUE(store_->find("x-1").value().cancel_requested);
    EXPECT_TRUE(store_->find("x-" + std::to_string(kLarge - 1)).value().finished_at);
    EXPECT_TRUE(holding("x-1").value().cancel_requested);
    EXPECT_FALSE(cancel_batch("nobody"));
    EXPECT_THAT(cancel_batch("x").value(), testing::SizeIs(running->size())) << "once more does no harm";
}

TEST_P(StoreConformance, CancellingABatchThatHasEndedChangesNothing) {
    open_batch("x");
    add_waiting("x", 0, 1);
    seal("x", "key");
    claim();
    finish("x-0", JobStatus::failed, "{}", R"({"type":"timeout"})");
    EXPECT_THAT(cancel_batch("x"), testing::Optional(testing::IsEmpty()));
    EXPECT_FALSE(batch("x").cancel_requested);
    EXPECT_EQ(requeue("x-0"), RequeueEffect::requeued);
    cancel_batch("x");
    EXPECT_TRUE(batch("x").cancel_requested) << "it goes on";
    cancel_batch("x");
    EXPECT_TRUE(batch("x").cancel_requested) << "as it was when it ended";
}

TEST_P(StoreConformance, ACancelledBatchTakesNoMoreAndItsInterruptedEntriesAreNotQueuedAgain) {
    open_batch("x");
    add_waiting("x", 0, 3);
    claim(kDead, "dead");
    claim(kAlive);
    cancel_batch("x");
    EXPECT_FALSE(add_waiting("x", 3, 1));
    EXPECT_EQ(reclaim().interrupted, 0U);
    EXPECT_EQ(status("x-0"), JobStatus::cancelled);
    EXPECT_TRUE(release("x-1"));
    EXPECT_EQ(status("x-1"), JobStatus::cancelled);
    EXPECT_FALSE(claim());
}

TEST_P(StoreConformance, OnlyAnEndedBatchIsRemovedAndOnlyAsAWhole) {
    EXPECT_EQ(remove_batch("x"), RemoveEffect::none);
    open_batch("x");
    EXPECT_EQ(remove_batch("x"), RemoveEffect::not_ended) << "it is being received";
    add_waiting("x", 0, 2);
    seal("x", "key");
    EXPECT_EQ(remove_batch("x"), RemoveEffect::not_ended);
    claim_many(2);
    EXPECT_EQ(remove_batch("x"), RemoveEffect::not_ended);
    finish("x-0", JobStatus::succeeded, "{}");
    finish("x-1", JobStatus::succeeded, "{}");
    EXPECT_EQ(remove("x-0"), RemoveEffect::in_batch);
    EXPECT_EQ(remove_batch("x"), RemoveEffect::removed);
    EXPECT_FALSE(store_->find_batch("x"));
    EXPECT_FALSE(store_->find("x-0"));
    EXPECT_FALSE(store_->batch_of_key("", "key"));
}

TEST_P(StoreConformance, BatchesAreListedNewestFirstByOwnerAndPageByPage) {
    for (const char* id : {"a", "b", "c", "d"}) open_batch(id, *id == 'b' ? "you" : "me");
    const auto ids_of = [](const BatchPage& page) {
        Ids ids;
        for (const BatchSummary& summary : page.batches) ids.push_back(summary.id);
        return ids;
    };
    EXPECT_THAT(ids_of(store_->list_batches(std::nullopt, 10, std::nullopt)), ElementsAre("d", "c", "b", "a"));
    const BatchPage first = store_->list_batches("me", 2, std::nullopt);
    EXPECT_THAT(ids_of(first), ElementsAre("d", "c"));
    EXPECT_TRUE(first.more);
    const BatchPage second = store_->list_batches("me", 2, first.batches.back().seq);
    EXPECT_THAT(ids_of(second), ElementsAre("a"));
    EXPECT_FALSE(second.more);
}

TEST_P(StoreConformance, ABatchAndItsEntriesAreTheSameAfterReopening) {
    make_batch("x", 4);
    claim_many(2);
    finish("x-0", JobStatus::succeeded, "{}");
    finish("x-1", JobStatus::failed, "", "{}");
    reopen();
    const BatchSummary counts = batch("x");
    EXPECT_EQ(counts.succeeded, 1U);
    EXPECT_EQ(counts.failed, 1U);
    EXPECT_EQ(counts.queued, 2U);
    EXPECT_THAT(claim_all(), ElementsAre("x-2", "x-3"));
}

}  // namespace
}  // namespace tunewright::server
