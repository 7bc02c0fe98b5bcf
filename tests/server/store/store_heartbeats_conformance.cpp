// Heartbeats: a worker sends one for all its jobs, with their progress, and gets the list of its jobs.
#include "tests/server/store/store_conformance.h"

namespace tunewright::server {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST_P(StoreConformance, ASignOfLifeKeepsAllJobsOfItsWorkerAndNobodyElses) {
    for (const char* id : {"a", "b", "c"}) accept(job(id));
    claim_many(2, kDead, "beats");
    claim(kDead, "silent");
    EXPECT_THAT(holdings("beats"), ElementsAre(seq_of("a"), seq_of("b")));
    EXPECT_EQ(reclaim().interrupted, 1U);
    EXPECT_EQ(status("a"), JobStatus::running);
    EXPECT_EQ(status("b"), JobStatus::running);
    EXPECT_EQ(status("c"), JobStatus::queued);
}

TEST_P(StoreConformance, AClaimIsASignOfLifeForWhatItsWorkerHadBefore) {
    for (const char* id : {"a", "b"}) accept(job(id));
    claim(kDead);
    claim(kAlive);
    EXPECT_EQ(reclaim().interrupted, 0U);
    EXPECT_EQ(status("a"), JobStatus::running);
}

TEST_P(StoreConformance, AShorterLeaseTakesNothingFromALongerOne) {
    for (const char* id : {"a", "b"}) accept(job(id));
    claim(kAlive);
    EXPECT_THAT(holdings("worker", kDead), ElementsAre(seq_of("a")));
    claim(kDead);
    EXPECT_EQ(reclaim().interrupted, 0U);
}

TEST_P(StoreConformance, AWorkerLearnsWhichAttemptItHasAndSinceWhen) {
    for (const char* id : {"a", "b"}) accept(job(id));
    claim(kAlive, "one");
    release("a");
    const JobRecord again = claim(kAlive, "one").value();
    claim(kAlive, "another");
    const auto held = beat("one");
    ASSERT_EQ(held.size(), 1U);
    EXPECT_EQ(held[0].seq, seq_of("a"));
    EXPECT_EQ(held[0].attempts, 2);
    EXPECT_EQ(held[0].since, again.started_at);
    EXPECT_FALSE(held[0].cancel_requested);
    EXPECT_THAT(holdings("another"), ElementsAre(seq_of("b")));
    EXPECT_THAT(holdings("a third that never claimed"), IsEmpty());
}

TEST_P(StoreConformance, WhatIsNotAWorkersAnyLongerIsNotNamed) {
    for (const char* id : {"ended", "released", "kept"}) accept(job(id));
    claim_many(3);
    finish("ended", JobStatus::succeeded, "{}");
    release("released");
    EXPECT_THAT(holdings(), ElementsAre(seq_of("kept")));
    EXPECT_EQ(claim(kAlive, "heir").value().id, "released");
    EXPECT_THAT(holdings(), ElementsAre(seq_of("kept")));
    EXPECT_THAT(holdings("heir"), ElementsAre(seq_of("released")));
}

TEST_P(StoreConformance, AWorkerThatComesBackTooLateHasNothing) {
    accept(job("a"));
    claim(kDead, "late");
    EXPECT_EQ(reclaim().interrupted, 1U);
    EXPECT_THAT(holdings("late"), IsEmpty()) << "it waits";
    EXPECT_EQ(status("a"), JobStatus::queued);
    ASSERT_EQ(claim(kAlive, "heir").value().attempts, 2);
    EXPECT_THAT(holdings("late"), IsEmpty());
    EXPECT_EQ(holding("a", "heir").value().attempts, 2);
}

TEST_P(StoreConformance, ACancelIsToldWithTheNextSignOfLife) {
    for (const char* id : {"a", "b"}) accept(job(id));
    claim_many(2);
    EXPECT_EQ(cancel("b"), CancelEffect::requested);
    EXPECT_FALSE(holding("a").value().cancel_requested);
    EXPECT_TRUE(holding("b").value().cancel_requested);
    EXPECT_TRUE(holding("b").value().cancel_requested) << "again and again, until it has ended";
    finish("b", JobStatus::cancelled, "");
    EXPECT_FALSE(holding("b"));
    EXPECT_TRUE(store_->find("b").value().cancel_requested);
}

TEST_P(StoreConformance, ProgressIsThatOfThePresentAttempt) {
    accept(job("a"));
    claim(kDead);
    EXPECT_EQ(store_->find("a").value().progress, "");
    beat("worker", kDead, {note("a", R"({"stage":"one"})")});
    EXPECT_EQ(store_->find("a").value().progress, R"({"stage":"one"})");
    beat("worker", kDead, {note("a", R"({"stage":"two"})")});
    beat("worker", kDead);
    EXPECT_EQ(store_->states({"a"}).at(0).progress, R"({"stage":"two"})") << "without news it stays as it is";
    reclaim();
    EXPECT_EQ(store_->find("a").value().progress, "");
    claim();
    EXPECT_EQ(store_->find("a").value().progress, "") << "that was of the attempt before";
    beat("worker", kAlive, {note("a", R"({"stage":"late"})", 1)});
    EXPECT_EQ(store_->states({"a"}).at(0).progress, "");
    beat("worker", kAlive, {note("a", R"({"stage":"new"})", 2)});
    EXPECT_EQ(store_->states({"a"}).at(0).progress, R"({"stage":"new"})");
}

TEST_P(StoreConformance, ProgressIsTakenOnlyFromTheWorkerThatHasTheJob) {
    for (const char* id : {"a", "b", "waiting"}) accept(job(id));
    claim(kAlive, "one");
    claim(kAlive, "two");
    const std::string text = R"({"by":"two, of \"b\""})";
    beat("two", kAlive, {note("a", text), note("waiting", text), note("nobody", text), note("b", text)});
    EXPECT_EQ(store_->find("a").value().progress, "");
    EXPECT_EQ(store_->find("waiting").value().progress, "");
    EXPECT_EQ(store_->find("b").value().progress, text) << "notes that come to nothing do not stop the others";
}

TEST_P(StoreConformance, ManySignsOfLifeAtOnceLoseNothing) {
    constexpr int count = 40;
    for (int i = 0; i < count; i++) accept(job("job" + std::to_string(i)));
    for (int i = 0; i < count; i++) claim(kDead, "worker" + std::to_string(i % 4));
    std::vector<std::promise<std::size_t>> beats(count);
    for (int i = 0; i < count; i++)
        store_->beat({"worker" + std::to_string(i % 4), now(), kAlive, {}},
                     [&beats, i](const Outcome<std::vector<Holding>>& outcome) {
                         beats[static_cast<std::size_t>(i)].set_value(std::get<0>(outcome).size());
                     });
    for (auto& beat : beats) EXPECT_EQ(beat.get_future().get(), 10U);
    EXPECT_EQ(reclaim().interrupted, 0U);
}

}  // namespace
}  // namespace tunewright::server
