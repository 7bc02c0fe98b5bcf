// Notifications of ends: each end has one, which is kept until it is settled.
#include "tests/server/store/store_conformance.h"

namespace tunewright::server {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using namespace std::chrono_literals;

NewBatch noted_batch(const std::string& id, UnixMs created_at = 1000) {
    NewBatch made;
    made.id = id;
    made.created_at = created_at;
    made.notify = {"https://example.org/" + id, "main"};
    return made;
}

TEST_P(StoreConformance, EachWayThatAJobCanEndIsTold) {
    const auto run = [&](const std::string& id, Milliseconds lease) {
        accept(noted_job(id));
        EXPECT_EQ(claim(lease, lease == kDead ? "dead" : "worker").value().id, id);
        EXPECT_THAT(tell(), IsEmpty()) << "it runs";
    };
    run("succeeded", kAlive);
    finish("succeeded", JobStatus::succeeded, "{}");
    EXPECT_THAT(tell(), ElementsAre("succeeded"));
    run("failed", kAlive);
    finish("failed", JobStatus::failed, "", "{}");
    EXPECT_THAT(tell(), ElementsAre("failed"));
    run("cancelled-by-its-worker", kAlive);
    finish("cancelled-by-its-worker", JobStatus::cancelled, "");
    EXPECT_THAT(tell(), ElementsAre("cancelled-by-its-worker"));
    run("given-up", kDead);
    reclaim(1);
    EXPECT_THAT(tell(), ElementsAre("given-up"));
    run("cancelled-at-its-release", kAlive);
    cancel("cancelled-at-its-release");
    EXPECT_THAT(tell(), IsEmpty()) << "that was only asked for";
    release("cancelled-at-its-release");
    EXPECT_THAT(tell(), ElementsAre("cancelled-at-its-release"));
    run("cancelled-instead-of-interrupted", kDead);
    cancel("cancelled-instead-of-interrupted");
    reclaim();
    EXPECT_THAT(tell(), ElementsAre("cancelled-instead-of-interrupted"));
    accept(noted_job("cancelled-before-it-began"));
    cancel("cancelled-before-it-began");
    EXPECT_THAT(tell(), ElementsAre("cancelled-before-it-began"));
}

TEST_P(StoreConformance, WhatDoesNotEndOrWhereNobodyAskedIsNotTold) {
    accept(noted_job("a"));
    claim();
    release("a");
    claim(kDead, "dead");
    EXPECT_EQ(reclaim().interrupted, 1U);
    accept(job("b"));
    cancel("b");
    EXPECT_THAT(tell(), IsEmpty());
    ASSERT_EQ(claim().value().attempts, 3);
    EXPECT_FALSE(finish("a", JobStatus::succeeded, "{}", "", 1)) << "of an attempt that was lost";
    EXPECT_THAT(tell(), IsEmpty());
    EXPECT_TRUE(finish("a", JobStatus::succeeded, "{}", "", 3));
    EXPECT_FALSE(finish("a", JobStatus::succeeded, "{}", "", 3));
    EXPECT_EQ(cancel("a"), CancelEffect::ended);
    EXPECT_THAT(tell(), ElementsAre("a")) << "once";
}

TEST_P(StoreConformance, ADeliveryNamesItsTargetAndWhatItIsAbout) {
    NewJob first = noted_job("a");
    first.notify = {"https://example.org/hook?of=a&b=%20", "second"};
    NewJob plain = noted_job("b");
    plain.notify = {"http://[::1]:8080/", ""};
    for (const NewJob& made : {first, plain}) accept(made);
    accept(job("silent"));
    for (const JobRecord& claimed : claim_many(3))
        EXPECT_EQ(claimed.notifies, claimed.id != "silent") << "whoever computes it knows whether to wake the notifier";
    finish("a", JobStatus::succeeded, "{}");
    const auto due = take(3000);
    ASSERT_EQ(due.size(), 1U);
    EXPECT_EQ(due[0].target.url, first.notify.url);
    EXPECT_EQ(due[0].target.secret_id, "second");
    EXPECT_EQ(due[0].job, "a");
    EXPECT_EQ(due[0].batch, "");
    EXPECT_EQ(due[0].tries, 0);
    EXPECT_EQ(due[0].created_at, 3000);
    finish("b", JobStatus::succeeded, "{}");
    const auto other = take(3000);
    ASSERT_EQ(other.size(), 1U);
    EXPECT_EQ(other[0].target.url, "http://[::1]:8080/");
    EXPECT_EQ(other[0].target.secret_id, "");
    EXPECT_NE(other[0].seq, due[0].seq);
}

TEST_P(StoreConformance, TheOldestEndIsToldFirst) {
    for (const char* id : {"a", "b", "c", "d"}) accept(noted_job(id));
    claim_many(4);
    finish("a", JobStatus::succeeded, "{}", "", 1, 6000);
    finish("b", JobStatus::succeeded, "{}", "", 1, 4000);
    finish("c", JobStatus::succeeded, "{}", "", 1, 5000);
    finish("d", JobStatus::succeeded, "{}", "", 1, 3000);
    const auto ids = [](const std::vector<Delivery>& deliveries) {
        Ids found;
        for (const Delivery& delivery : deliveries) found.push_back(delivery.job);
        return found;
    };
    EXPECT_THAT(take(2999), IsEmpty()) << "none is due";
    EXPECT_THAT(ids(take(10'000, 1)), ElementsAre("d"));
    EXPECT_THAT(ids(take(10'000, 3)), ElementsAre("b", "c", "a"));
}

TEST_P(StoreConformance, WhatSomebodyHasTakenIsNobodyElsesForAWhile) {
    accept(noted_job("a"));
    cancel("a");
    const auto taken = take(3000, 10, 1s);
    ASSERT_EQ(taken.size(), 1U);
    EXPECT_THAT(take(3000), IsEmpty());
    EXPECT_THAT(take(3999), IsEmpty());
    reopen();
    const auto again = take(4000, 10, 1s);
    ASSERT_EQ(again.size(), 1U) << "who took it did not say what came of it";
    EXPECT_EQ(again[0].seq, taken[0].seq);
    EXPECT_EQ(again[0].tries, 0) << "perhaps it was not even tried";
    EXPECT_TRUE(settle(again[0].seq));
    EXPECT_FALSE(settle(again[0].seq));
    EXPECT_THAT(take(soon()), IsEmpty());
}

TEST_P(StoreConformance, ADeliveryThatFailedIsDueAgainAfterItsPauseAndCountsItsTries) {
    accept(noted_job("a"));
    cancel("a");
    const std::int64_t seq = take(3000).at(0).seq;
    EXPECT_TRUE(settle(seq, 4000, 2s));
    EXPECT_THAT(take(5999), IsEmpty());
    EXPECT_EQ(take(6000).at(0).tries, 1);
    EXPECT_TRUE(settle(seq, 7000, 5s));
    EXPECT_EQ(take(12'000).at(0).tries, 2);
    EXPECT_FALSE(settle(seq + 1000, 12'000, 5s));
    EXPECT_TRUE(settle(seq)) << "given up";
    EXPECT_THAT(take(soon()), IsEmpty());
}

TEST_P(StoreConformance, ManyTakersAtOnceNeverGetTheSame) {
    constexpr int count = 60;
    for (int i = 0; i < count; i++) accept(noted_job("job" + std::to_string(i)));
    for (int i = 0; i < count; i++) cancel("job" + std::to_string(i));
    using Taken = std::vector<Delivery>;
    std::vector<std::promise<Taken>> takers(count / 4 + 5);
    for (auto& taker : takers)
        store_->take_deliveries(soon(), kAlive, 4,
                                [&taker](auto outcome) { taker.set_value(std::get<Taken>(std::move(outcome))); });
    std::set<std::string> ids;
    for (auto& taker : takers)
        for (const Delivery& delivery : taker.get_future().get()) EXPECT_TRUE(ids.insert(delivery.job).second);
    EXPECT_EQ(ids.size(), count);
}

TEST_P(StoreConformance, ABatchIsToldOnceAndItsEntriesAreNot) {
    open_batch(noted_batch("x"));
    add_waiting("x", 0, 2);
    claim_many(2);
    finish("x-0", JobStatus::succeeded, "{}");
    finish("x-1", JobStatus::failed, "", "{}");
    reclaim();
    EXPECT_THAT(take(soon()), IsEmpty()) << "more of it may come";
    seal("x");
    reclaim();
    const auto due = take(soon());
    ASSERT_EQ(due.size(), 1U);
    EXPECT_EQ(due[0].batch, "x");
    EXPECT_EQ(due[0].job, "");
    EXPECT_EQ(due[0].target.url, "https://example.org/x");
    EXPECT_EQ(due[0].target.secret_id, "main");
    EXPECT_EQ(due[0].created_at, 3000) << "when its last job ended";
    for (int i = 0; i < 3; i++) reclaim();
    EXPECT_TRUE(settle(due[0].seq));
    reclaim();
    EXPECT_THAT(take(soon() + 2 * kAlive.count()), IsEmpty()) << "no second note was written";
}

TEST_P(StoreConformance, ABatchIsToldNotBeforeItsLastJobHasEnded) {
    make_batch(noted_batch("x"), 3);
    make_batch("y", 1);
    claim_many(2);
    finish("x-0", JobStatus::succeeded, "{}");
    finish("x-1", JobStatus::succeeded, "{}");
    reclaim();
    EXPECT_THAT(tell(), IsEmpty());
    claim_many(2);
    reclaim();
    EXPECT_THAT(tell(), IsEmpty()) << "one runs";
    finish("x-2", JobStatus::succeeded, "{}");
    finish("y-0", JobStatus::succeeded, "{}");
    reclaim();
    EXPECT_THAT(tell(), ElementsAre("x")) << "for the other nobody asked";
}

TEST_P(StoreConformance, CancelledAndEmptyBatchesAreToldAndDroppedOnesAreNot) {
    make_batch(noted_batch("cancelled"), 300);
    cancel_batch("cancelled");
    reclaim();
    EXPECT_THAT(tell(), ElementsAre("cancelled"));
    make_batch(noted_batch("empty"), 0);
    reclaim();
    EXPECT_THAT(tell(), ElementsAre("empty"));
    open_batch(noted_batch("dropped", now()));
    add_waiting("dropped", 0, 3);
    drop("dropped");
    reclaim();
    EXPECT_THAT(tell(), IsEmpty());
}

TEST_P(StoreConformance, WhatIsQueuedAgainIsToldAgainWhenItEnds) {
    accept(noted_job("a"));
    cancel("a");
    EXPECT_THAT(tell(), ElementsAre("a"));
    requeue("a");
    EXPECT_THAT(tell(), IsEmpty());
    cancel("a");
    EXPECT_THAT(tell(), ElementsAre("a"));
    make_batch(noted_batch("x"), 1);
    cancel("x-0");
    reclaim();
    EXPECT_THAT(tell(), ElementsAre("x"));
    requeue("x-0");
    reclaim();
    EXPECT_THAT(tell(), IsEmpty());
    cancel("x-0");
    reclaim();
    EXPECT_THAT(tell(), ElementsAre("x"));
}

}  // namespace
}  // namespace tunewright::server
