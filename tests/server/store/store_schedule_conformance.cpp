// Scheduled jobs, unique jobs, and the limit of jobs per client.
#include <thread>

#include "tests/server/store/store_conformance.h"

namespace tunewright::server {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A shared store uses its own clock: times are relative to now.
constexpr UnixMs kHour = 3'600'000;

NewJob at(NewJob job, UnixMs time) {
    job.not_before = time;
    job.created_at = wall_clock();
    return job;
}

NewJob unique(NewJob job) {
    job.unique = true;
    job.idempotency_key = " unique " + job.request_hash;
    return job;
}

NewJob limited(NewJob job, std::size_t limit) {
    job.client_limit = limit;
    return job;
}

/// Number of jobs moved.
std::size_t start_due(JobStore& store, UnixMs time = wall_clock()) {
    return completed<std::size_t>([&](auto done) { store.start_due(time, done); });
}

/// Repeats until this number have been moved: a shared store's clock may be some milliseconds behind.
std::size_t start_soon_due(JobStore& store, std::size_t count) {
    std::size_t started = 0;
    for (int tries = 0; tries < 1000 && started < count; tries++) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
        started += start_due(store);
    }
    return started;
}

}  // namespace

TEST_P(StoreConformance, AScheduledJobWaitsAndIsHandedOutToNobody) {
    const UnixMs time = now() + kHour;
    const Accepted accepted = accept(at(job("a"), time));
    EXPECT_EQ(accepted.kind, Accepted::Kind::created);
    EXPECT_EQ(accepted.job.not_before, time);
    EXPECT_EQ(start_due(*store_), 0U);
    EXPECT_EQ(start_due(*store_, time - 1), 0U);
    EXPECT_FALSE(claim());
    EXPECT_TRUE(claim_by({"worker", now(), kAlive, 5, false, true}).empty());
    EXPECT_TRUE(claim_by({"worker", now(), kAlive, 5, true, false}).empty());
    EXPECT_EQ(waiting(), 1U);
    EXPECT_FALSE(store_->depth().next_single) << "its time has not come: it is nobody's turn";
    const JobRecord found = store_->find("a").value();
    EXPECT_EQ(found.status, JobStatus::queued);
    EXPECT_EQ(found.not_before, time);
    JobQuery queued;
    queued.status = JobStatus::queued;
    ASSERT_EQ(store_->list(queued).jobs.size(), 1U);
    EXPECT_EQ(store_->list(queued).jobs[0].not_before, time);
    EXPECT_EQ(remove("a"), RemoveEffect::not_ended);
    EXPECT_EQ(requeue("a"), RequeueEffect::not_failed);
    accept(job("b"));
    EXPECT_THAT(claim_all(), ElementsAre("b")) << "the others go on";
}

TEST_P(StoreConformance, AScheduledJobTakesItsTurnWhenItsTimeHasCome) {
    const UnixMs time = now() + 150;
    accept(at(job("later", "x"), time + kHour));
    accept(at(job("second", "x"), time + 1));
    accept(at(job("first", "x"), time));
    accept(at(low_job("low", "y"), time));
    for (const char* id : {"x1", "x2", "x3"}) accept(job(id, "x"));
    EXPECT_EQ(start_soon_due(*store_, 3), 3U);
    EXPECT_GE(now(), time);
    EXPECT_THAT(claim_all(), ElementsAre("x1", "x2", "x3", "first", "second", "low"))
        << "as if they had just come, in the order of their times";
    EXPECT_EQ(store_->find("first").value().not_before, time);
    EXPECT_TRUE(finish("first", JobStatus::succeeded, "{}", "", 1, soon()));
    EXPECT_EQ(status("later"), JobStatus::queued);
}

TEST_P(StoreConformance, ATimeThatIsOverIsNone) {
    const Accepted accepted = accept(at(job("a"), now() - 1));
    EXPECT_FALSE(accepted.job.not_before);
    EXPECT_FALSE(store_->find("a").value().not_before);
    EXPECT_THAT(claim_all(), ElementsAre("a"));
}

TEST_P(StoreConformance, TheAgeOfAJobThatWasScheduledCountsFromItsTime) {
    const UnixMs time = now() + 20;
    accept(at(job("a"), time));
    accept(job("old"));  // of the year 1970
    EXPECT_EQ(store_->depth().next_single, 1000);
    ASSERT_EQ(claim().value().id, "old");
    EXPECT_EQ(start_soon_due(*store_, 1), 1U);
    EXPECT_EQ(store_->depth().next_single, time);
    EXPECT_EQ(claim().value().not_before, time);
}

TEST_P(StoreConformance, AScheduledJobOutlivesItsProcessAndAPause) {
    accept(at(job("a"), now() + 800));
    accept(at(job("later"), now() + kHour));
    pause(true);
    reopen();
    EXPECT_EQ(waiting(), 2U);
    EXPECT_EQ(start_soon_due(*store_, 1), 1U);
    EXPECT_FALSE(claim()) << "it is due, but nothing is handed out";
    pause(false);
    EXPECT_THAT(claim_all(), ElementsAre("a"));
    EXPECT_TRUE(release("a"));
    EXPECT_THAT(claim_all(), ElementsAre("a")) << "one that was given back does not wait for its time again";
}

TEST_P(StoreConformance, AScheduledJobIsCancelledAndQueuedAgainForItsTime) {
    accept(at(noted_job("a"), now() + kHour));
    EXPECT_EQ(cancel("a"), CancelEffect::cancelled);
    EXPECT_EQ(waiting(), 0U);
    EXPECT_EQ(status("a"), JobStatus::cancelled);
    EXPECT_THAT(tell(), ElementsAre("a"));
    EXPECT_EQ(cancel("a"), CancelEffect::ended);
    EXPECT_EQ(requeue("a"), RequeueEffect::requeued);
    EXPECT_EQ(waiting(), 1U);
    EXPECT_FALSE(claim()) << "its time has still not come";
    EXPECT_EQ(cancel("a"), CancelEffect::cancelled);
    EXPECT_EQ(remove("a"), RemoveEffect::removed);
    EXPECT_EQ(waiting(), 0U);
    accept(at(job("past"), now() + 20));
    EXPECT_EQ(cancel("past"), CancelEffect::cancelled);
    std::this_thread::sleep_for(Milliseconds(1100));
    EXPECT_EQ(requeue("past"), RequeueEffect::requeued);
    EXPECT_THAT(claim_all(), ElementsAre("past")) << "its time is over";
}

TEST_P(StoreConformance, EachDueJobIsMovedOnceHoweverManyAsk) {
    for (int i = 0; i < 50; i++) accept(at(job("j" + std::to_string(i), "flow" + std::to_string(i % 3)), now() + 800));
    std::this_thread::sleep_for(Milliseconds(1100));
    std::vector<std::promise<std::size_t>> answers(10);
    for (auto& answer : answers)
        store_->start_due(now(),
                          [&](const Outcome<std::size_t>& out) { answer.set_value(std::get<std::size_t>(out)); });
    std::size_t started = 0;
    for (auto& answer : answers) started += answer.get_future().get();
    EXPECT_EQ(started, 50U);
    EXPECT_EQ(claim_all().size(), 50U);
    EXPECT_EQ(waiting(), 0U);
}

TEST_P(StoreConformance, AUniqueJobIsTheEarlierOneUnlessThatFailedOrWasCancelled) {
    const NewJob first = unique(job("a"));
    const auto again = [&](const std::string& id) {
        NewJob same = first;
        same.id = id;
        const Accepted accepted = accept(same);
        EXPECT_NE(accepted.kind, Accepted::Kind::conflict);
        EXPECT_EQ(accepted.kind == Accepted::Kind::created, accepted.job.id == id);
        return accepted.job.id;
    };
    EXPECT_EQ(accept(first).kind, Accepted::Kind::created);
    EXPECT_EQ(again("b"), "a") << "it waits";
    claim();
    EXPECT_EQ(again("b"), "a") << "it runs";
    finish("a", JobStatus::failed, "", R"({"type":"e"})");
    EXPECT_EQ(again("b"), "b") << "it has failed";
    EXPECT_EQ(again("c"), "b");
    EXPECT_EQ(cancel("b"), CancelEffect::cancelled);
    EXPECT_EQ(again("c"), "c") << "it was cancelled";
    claim();
    finish("c", JobStatus::succeeded, "{}");
    EXPECT_EQ(again("d"), "c") << "it has succeeded";
    EXPECT_EQ(remove("c"), RemoveEffect::removed);
    EXPECT_EQ(again("d"), "d") << "it is not kept";
    NewJob other = unique(job("e"));
    other.request_hash = first.request_hash;
    other.idempotency_key = first.idempotency_key;
    other.owner = "somebody else";
    EXPECT_EQ(accept(other).kind, Accepted::Kind::created);
}

TEST_P(StoreConformance, AUniqueJobIsNotQueuedAgainWhereALaterOneHasItsPlace) {
    const auto post = [&](const std::string& id, const std::string& owner = "") {
        NewJob made = unique(job("a"));
        made.id = id;
        made.owner = owner;
        return accept(made).job.id;
    };
    post("a");
    cancel("a");
    EXPECT_EQ(requeue("a"), RequeueEffect::requeued) << "nobody has taken its place";
    EXPECT_EQ(post("b"), "a") << "it is the unique one as before";
    cancel("a");
    EXPECT_EQ(post("b"), "b");
    EXPECT_EQ(requeue("a"), RequeueEffect::superseded) << "the later one waits";
    EXPECT_EQ(status("a"), JobStatus::cancelled);
    claim();
    EXPECT_EQ(requeue("a"), RequeueEffect::superseded) << "it runs";
    finish("b", JobStatus::succeeded, "{}");
    EXPECT_EQ(requeue("a"), RequeueEffect::superseded) << "it has succeeded";
    remove("b");
    EXPECT_EQ(requeue("a"), RequeueEffect::requeued) << "it is not kept";
    EXPECT_EQ(post("c"), "a");
    cancel("a");
    EXPECT_EQ(post("c"), "c");
    cancel("c");
    EXPECT_EQ(requeue("a"), RequeueEffect::requeued) << "the later one was cancelled too";
    EXPECT_EQ(requeue("c"), RequeueEffect::superseded);
    EXPECT_EQ(post("d"), "a");
    EXPECT_EQ(post("d", "somebody else"), "d");
    EXPECT_EQ(waiting(), 2U);
}

TEST_P(StoreConformance, OfManyUniqueJobsAtOnceOneIsMade) {
    std::vector<std::promise<Accepted>> answers(40);
    for (std::size_t i = 0; i < answers.size(); i++) {
        NewJob made = unique(job("a"));
        made.id = "a" + std::to_string(i);
        store_->accept(made,
                       [&answers, i](const Outcome<Accepted>& out) { answers[i].set_value(std::get<Accepted>(out)); });
    }
    std::set<std::string> ids;
    for (auto& answer : answers) ids.insert(answer.get_future().get().job.id);
    EXPECT_EQ(ids.size(), 1U);
    EXPECT_EQ(waiting(), 1U);
}

TEST_P(StoreConformance, AClientHasSoManyJobsUnderWayAndNoMore) {
    const auto post = [&](const std::string& id, const std::string& flow = "x") {
        return accept(limited(job(id, flow), 3)).kind;
    };
    using Kind = Accepted::Kind;
    EXPECT_EQ(post("a"), Kind::created);
    EXPECT_EQ(accept(limited(at(low_job("b", "x"), now() + kHour), 3)).kind, Kind::created);
    EXPECT_EQ(accept(limited(low_job("c", "x"), 3)).kind, Kind::created);
    EXPECT_EQ(post("d"), Kind::too_many) << "one waits, one is scheduled, one is of low priority";
    EXPECT_FALSE(store_->find("d"));
    EXPECT_EQ(post("other", "y"), Kind::created) << "others have a count of their own";
    EXPECT_EQ(claim().value().id, "a");
    EXPECT_EQ(post("d"), Kind::too_many) << "one runs";
    finish("a", JobStatus::succeeded, "{}");
    EXPECT_EQ(post("d"), Kind::created);
    EXPECT_EQ(post("e"), Kind::too_many);
    cancel("b");
    EXPECT_EQ(post("e"), Kind::created);
    make_batch("batch", 5, "z");
    for (const char* id : {"z1", "z2", "z3"}) EXPECT_EQ(post(id, "z"), Kind::created) << "entries do not count";
    EXPECT_EQ(post("z4", "z"), Kind::too_many);
    EXPECT_EQ(accept(job("z5", "z")).kind, Kind::created) << "without a limit";
}

TEST_P(StoreConformance, AJobThatIsThereIsAnsweredWhateverTheLimit) {
    NewJob made = limited(job("a", "x"), 1);
    made.idempotency_key = "key";
    EXPECT_EQ(accept(made).kind, Accepted::Kind::created);
    made.id = "b";
    EXPECT_EQ(accept(made).kind, Accepted::Kind::existing);
    made.request_hash = "another";
    EXPECT_EQ(accept(made).kind, Accepted::Kind::conflict);
    cancel("a");
    accept(job("c", "x"));
    EXPECT_EQ(accept(unique(limited(job("d", "x"), 1))).kind, Accepted::Kind::too_many);
}

TEST_P(StoreConformance, RepeatedPostsTakeNoPlaceUnderTheLimit) {
    const auto keyed = [&](const std::string& id, const std::string& key) {
        NewJob made = limited(job(id, "x"), 4);
        made.idempotency_key = key;
        return made;
    };
    accept(keyed("a", "known"));
    std::vector<NewJob> posts;
    for (int i = 0; i < 20; i++) posts.push_back(keyed("known" + std::to_string(i), "known"));
    for (int i = 0; i < 20; i++) posts.push_back(keyed("twice" + std::to_string(i), "twice"));
    posts.push_back(keyed("b", ""));
    posts.push_back(keyed("c", "new"));
    std::vector<std::promise<Accepted::Kind>> answers(posts.size());
    for (std::size_t i = 0; i < posts.size(); i++)
        store_->accept(posts[i], [&answers, i](const Outcome<Accepted>& out) {
            answers[i].set_value(std::get<Accepted>(out).kind);
        });
    int too_many = 0;
    for (auto& answer : answers) too_many += answer.get_future().get() == Accepted::Kind::too_many ? 1 : 0;
    EXPECT_EQ(too_many, 0) << "a, one of the key that came twice, b and c";
    EXPECT_EQ(waiting(), 4U);
    EXPECT_EQ(accept(keyed("d", "")).kind, Accepted::Kind::too_many);
}

TEST_P(StoreConformance, ManyPostsAtOnceDoNotPassTheLimit) {
    std::vector<std::promise<Accepted::Kind>> answers(60);
    for (std::size_t i = 0; i < answers.size(); i++)
        store_->accept(
            limited(job("a" + std::to_string(i), i % 2 == 0 ? "x" : "y"), 7),
            [&answers, i](const Outcome<Accepted>& out) { answers[i].set_value(std::get<Accepted>(out).kind); });
    int created = 0;
    for (auto& answer : answers) created += answer.get_future().get() == Accepted::Kind::created ? 1 : 0;
    EXPECT_EQ(created, 14);
    EXPECT_EQ(claim_all().size(), 14U);
    EXPECT_THAT(claim_all(), IsEmpty());
}

}  // namespace tunewright::server
