// Single jobs: accepted, claimed, ended, cancelled, removed, listed.
#include <map>

#include "tests/server/store/store_conformance.h"

namespace tunewright::server {
namespace {

TEST_P(StoreConformance, AnAcceptedJobIsReadBackAsItWasGiven) {
    NewJob made = job("a");
    made.origin = {"call 7", "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01"};
    const Accepted accepted = accept(made);
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
    EXPECT_EQ(found.request_id, made.origin.request_id);
    EXPECT_EQ(found.traceparent, made.origin.traceparent);
    EXPECT_FALSE(found.started_at || found.finished_at);
    EXPECT_FALSE(store_->find("b"));
    const JobRecord claimed = claim().value();
    EXPECT_EQ(claimed.seq, found.seq);
    EXPECT_EQ(claimed.request_id, made.origin.request_id) << "whoever computes it can name the call";
    EXPECT_EQ(claimed.traceparent, made.origin.traceparent);
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
    const UnixMs before = now();
    for (const char* id : {"c", "a", "b"}) {
        const JobRecord claimed = claim().value();
        EXPECT_EQ(claimed.id, id);
        EXPECT_EQ(claimed.status, JobStatus::running);
        EXPECT_EQ(claimed.attempts, 1);
        EXPECT_GE(claimed.started_at.value(), before);
        EXPECT_LE(claimed.started_at.value(), now());
        EXPECT_EQ(claimed.request, job(id).request);
    }
    EXPECT_FALSE(claim());
}

TEST_P(StoreConformance, ManyClaimsAtOnceNeverGiveAJobTwice) {
    constexpr int count = 200;
    for (int i = 0; i < count; i++) accept(job("job" + std::to_string(i)));
    using Claimed = std::vector<JobRecord>;
    std::vector<std::promise<Claimed>> claims(count / 2 + 10);
    for (auto& promise : claims)
        store_->claim({"worker", now(), kAlive, 2},
                      [&promise](auto outcome) { promise.set_value(std::get<Claimed>(std::move(outcome))); });
    std::set<std::string> ids;
    int none = 0;
    for (auto& promise : claims) {
        const Claimed claimed = promise.get_future().get();
        if (claimed.empty()) none++;
        for (const JobRecord& record : claimed) EXPECT_TRUE(ids.insert(record.id).second) << record.id;
    }
    EXPECT_EQ(ids.size(), count);
    EXPECT_EQ(none, 10);
}

TEST_P(StoreConformance, AJobEndsOnceAndKeepsItsFirstEnd) {
    accept(job("a"));
    EXPECT_FALSE(finish("a", JobStatus::succeeded, "{}")) << "it is not running yet";
    claim();
    EXPECT_TRUE(finish(end_of("a", JobStatus::succeeded, R"({"x":1})", "", 1, kIn2096)));
    EXPECT_FALSE(finish("a", JobStatus::failed, "", R"({"type":"late"})"));
    const JobRecord found = store_->find("a").value();
    EXPECT_EQ(found.status, JobStatus::succeeded);
    EXPECT_EQ(found.result, R"({"x":1})");
    EXPECT_EQ(found.error, "");
    EXPECT_EQ(found.finished_at, kIn2096);
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

TEST_P(StoreConformance, ManyEndsAtOnceKeepTheirOwnTextsWhateverIsInThem) {
    const std::vector<std::string> texts{"",     R"({"a":"\\ ' \" {} , NULL"})", "süß 温度 😀",
                                         "last", std::string("\0\x01\xff", 3),   std::string(100'000, 'r') + "é"};
    const std::size_t count = texts.size();
    for (std::size_t i = 0; i < count; i++) accept(job("job" + std::to_string(i)));
    claim_many(count);
    std::vector<JobEnd> ends;
    for (std::size_t i = 0; i < count; i++)
        ends.push_back(end_of("job" + std::to_string(i), JobStatus::failed, texts[i], texts[count - 1 - i]));
    std::vector<std::promise<bool>> ended(count);
    for (std::size_t i = 0; i < count; i++)
        store_->finish(ends[i], [&ended, i](const auto& outcome) { ended[i].set_value(std::get<bool>(outcome)); });
    for (std::size_t i = 0; i < count; i++) {
        EXPECT_TRUE(ended[i].get_future().get());
        const JobRecord found = store_->find(ends[i].id).value();
        EXPECT_EQ(found.result, texts[i]) << i;
        EXPECT_EQ(found.error, texts[count - 1 - i]) << i;
    }
}

TEST_P(StoreConformance, AnOutlineStandsInListsAndIsSearchedByItsMethod) {
    for (const char* id : {"a", "b", "c"}) accept(job(id));
    claim_many(2);
    JobEnd end = end_of("a", JobStatus::succeeded, "{}");
    end.outline = R"({"plant":"b%","method":"simc"})";
    EXPECT_TRUE(finish(end));
    const auto ids_with = [&](const std::string& text) {
        JobQuery query;
        query.text = text;
        Ids ids;
        for (const JobSummary& summary : store_->list(query).jobs) ids.push_back(summary.id);
        return ids;
    };
    EXPECT_EQ(store_->find("a").value().outline, end.outline);
    EXPECT_EQ(store_->find("b").value().outline, "");
    EXPECT_THAT(ids_with("SIM"), testing::ElementsAre("a"));
    EXPECT_THAT(ids_with("Name of B"), testing::ElementsAre("b"));
    EXPECT_THAT(ids_with("name of"), testing::ElementsAre("c", "b", "a"));
    EXPECT_THAT(ids_with("%"), testing::IsEmpty()) << "neither a pattern nor looked for in the plant";
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

TEST_P(StoreConformance, OnlyEndedJobsAreRemovedAndNothingOfThemStays) {
    EXPECT_EQ(remove("a"), RemoveEffect::none);
    NewJob made = job("a");
    made.idempotency_key = "key";
    accept(made);
    EXPECT_EQ(remove("a"), RemoveEffect::not_ended);
    claim();
    EXPECT_EQ(remove("a"), RemoveEffect::not_ended);
    const JobEnd end = end_of("a", JobStatus::succeeded, "{}");
    EXPECT_TRUE(finish(end));
    EXPECT_EQ(remove("a"), RemoveEffect::removed);
    EXPECT_FALSE(store_->find("a"));
    EXPECT_FALSE(finish(end));
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

TEST_P(StoreConformance, KeysAreEachOwnersOwn) {
    NewJob mine = job("a");
    mine.owner = "me";
    mine.idempotency_key = "key";
    accept(mine);
    NewJob yours = job("b");
    yours.owner = "you";
    yours.idempotency_key = "key";
    EXPECT_EQ(accept(yours).kind, Accepted::Kind::created);
    mine.id = "c";
    EXPECT_EQ(accept(mine).job.id, "a");
}

TEST_P(StoreConformance, ListsFilterByOwner) {
    for (const char* owner : {"me", "you", "me"}) {
        NewJob made = job(std::string(owner) + std::to_string(store_->depth().single));
        made.owner = owner;
        accept(made);
    }
    JobQuery mine;
    mine.owner = "me";
    const JobPage page = store_->list(mine);
    ASSERT_EQ(page.jobs.size(), 2U);
    EXPECT_EQ(page.jobs[0].id, "me2");
    EXPECT_EQ(page.jobs[1].id, "me0");
    EXPECT_EQ(page.jobs[0].owner, "me");
    EXPECT_EQ(store_->list({}).jobs.size(), 3U);
}

TEST_P(StoreConformance, StatesAreThoseOfTheJobsThatThereAre) {
    accept(job("a"));
    accept(job("b"));
    claim();
    std::map<std::string, JobStatus> found;
    for (const JobState& state : store_->states({"b", "nobody", "a"})) found[state.id] = state.status;
    const std::map<std::string, JobStatus> expected{{"a", JobStatus::running}, {"b", JobStatus::queued}};
    EXPECT_EQ(found, expected);
    EXPECT_TRUE(store_->states({}).empty());
}

TEST_P(StoreConformance, DepthCountsWhatWaits) {
    EXPECT_EQ(store_->depth().single, 0U);
    for (const char* id : {"a", "b", "c"}) accept(job(id));
    make_batch("batch", 2);
    EXPECT_EQ(store_->depth().single, 3U);
    EXPECT_EQ(store_->depth().entries, 2U);
    claim();
    cancel("b");
    EXPECT_EQ(store_->depth().single, 1U);
    claim();
    claim();
    EXPECT_EQ(store_->depth().single, 0U);
    EXPECT_EQ(store_->depth().entries, 1U);
}

}  // namespace
}  // namespace tunewright::server
