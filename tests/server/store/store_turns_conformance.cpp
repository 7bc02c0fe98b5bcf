// Who is next: flows take turns, single jobs go before entries of batches.
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

}  // namespace
}  // namespace tunewright::server
