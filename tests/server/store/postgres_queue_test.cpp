// Times, pauses and locks of the queue that only a shared store has.
#include "tests/server/store/postgres_fixture.h"

namespace tunewright::server {
namespace {

TEST_F(PostgresStore, ItsClockAloneSaysWhetherTheTimeOfAJobHasCome) {
    constexpr UnixMs hour = 3'600'000;
    const auto store = open();
    const UnixMs now = wall_clock();
    const auto post = [&](const std::string& id, UnixMs posted_at, UnixMs time) {
        NewJob made = job(id);
        made.created_at = posted_at;
        made.not_before = time;
        return completed<Accepted>([&](auto done) { store->accept(made, done); }).job.not_before;
    };
    EXPECT_EQ(post("past", now - 2 * hour, now - hour), std::nullopt) << "the process's clock is behind";
    EXPECT_EQ(post("later", now + 2 * hour, now + hour), now + hour) << "and this one's ahead";
    const auto start_due = [&](UnixMs at) {
        return completed<std::size_t>([&](auto done) { store->start_due(at, done); });
    };
    EXPECT_EQ(start_due(now + 2 * hour), 0U);
    EXPECT_EQ(claim(*store, 5).size(), 1U);
    database_->run(
        "SET search_path TO tunewright; UPDATE waiting SET turn = turn - 3600000; UPDATE jobs SET turn = "
        "turn - 3600000 WHERE not_before IS NOT NULL");
    wait_until("SELECT turn < extract(epoch FROM clock_timestamp()) * 1000 FROM tunewright.waiting");
    EXPECT_EQ(start_due(now - 2 * hour), 1U);
    EXPECT_EQ(claim(*store, 5).at(0).id, "later");
}

TEST_F(PostgresStore, AScheduledJobThatCrashedUnderAnEarlierReleaseKeepsItsPause) {
    const auto store = open();
    NewJob made = job("a");
    made.not_before = wall_clock() + 3'600'000;
    completed<Accepted>([&](auto done) { store->accept(made, done); });
    database_->run(
        "UPDATE tunewright.waiting SET turn = 0, attempts = 2, crashes = 2, "
        "not_before = clock_timestamp() + interval '4 minutes'");
    EXPECT_EQ(completed<std::size_t>([&](auto done) { store->start_due(0, done); }), 1U);
    EXPECT_EQ(
        database_->run("SELECT class = 0 AND crashes = 2 AND not_before > clock_timestamp() + interval '3 minutes' "
                       "FROM tunewright.waiting"),
        "t");
    const Claim suspects{"worker", 2000, std::chrono::minutes(10), 1, true};
    EXPECT_TRUE(completed<std::vector<JobRecord>>([&](auto done) { store->claim(suspects, done); }).empty());
    EXPECT_EQ(store->depth().suspects, 0U);
}

TEST_F(PostgresStore, NothingIsWrittenWhereNoJobIsDue) {
    const auto store = open();
    NewJob made = job("a");
    made.not_before = wall_clock() + 3'600'000;
    completed<Accepted>([&](auto done) { store->accept(made, done); });
    const std::string next = "SELECT txid_snapshot_xmax(txid_current_snapshot())";
    const long before = std::stol(database_->run(next));
    for (int i = 0; i < 200; i++) EXPECT_EQ(completed<std::size_t>([&](auto done) { store->start_due(0, done); }), 0U);
    EXPECT_LT(std::stol(database_->run(next)) - before, 100) << "the server itself writes something now and then";
}

/// Two processes post the same unique jobs, which fail each time, in opposite orders.
TEST_F(PostgresStore, UniqueJobsInOppositeOrdersNeverWaitForEachOther) {
    constexpr int kinds = 12, rounds = 25;
    const auto one = open(), two = open();
    const auto post_all = [&](JobStore& store, int round, bool backwards, std::size_t limit) {
        std::vector<std::promise<void>> answers(kinds);
        for (int i = 0; i < kinds; i++) {
            const std::string kind = std::to_string(backwards ? kinds - 1 - i : i);
            NewJob made = job((backwards ? "b" : "a") + std::to_string(round) + "-" + kind);
            made.unique = true;
            made.request_hash = kind;
            made.idempotency_key = " unique " + kind;
            made.flow = "flow" + std::to_string(i % 3);
            made.client_limit = limit;
            store.accept(made, [&answers, i](const Outcome<Accepted>& out) {
                EXPECT_TRUE(std::holds_alternative<Accepted>(out));
                answers[static_cast<std::size_t>(i)].set_value();
            });
        }
        for (auto& answer : answers) answer.get_future().get();
    };
    for (int round = 0; round < rounds; round++) {
        const std::size_t limit = round % 2 == 0 ? 1000 : 0;
        {
            const std::jthread a([&] { post_all(*one, round, false, limit); });
            const std::jthread b([&] { post_all(*two, round, true, limit); });
            for (const JobRecord& claimed : claim(*one, 3)) {
                const JobEnd end{claimed.seq, claimed.id, 1, JobStatus::failed, "", "{}", "1", 3000};
                completed<bool>([&](auto done) { two->finish(end, done); });
            }
        }
        EXPECT_EQ(database_->run("SELECT count(*) FROM tunewright.jobs WHERE starts_with(idempotency_key, ' unique ')"),
                  std::to_string(kinds))
            << round;
        EXPECT_LE(std::stoi(database_->run("SELECT count(*) FROM tunewright.waiting")), kinds) << round;
        database_->run(
            "SET search_path TO tunewright; WITH gone AS (DELETE FROM waiting RETURNING seq) INSERT INTO ended (seq, "
            "single, status, attempts, cancel_requested, finished_at) SELECT seq, true, 'failed', 0, false, 1 FROM "
            "gone");
    }
    // The store's counts are up to a second old.
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    EXPECT_EQ(database_->run("SELECT deadlocks FROM pg_stat_database WHERE datname = current_database()"), "0");
}

/// Two processes queue failed jobs again in opposite orders, while others of the same keys and clients are posted.
TEST_F(PostgresStore, RequeuesInOppositeOrdersNeverWaitForEachOther) {
    constexpr int kinds = 12, rounds = 25;
    const auto one = open(), two = open();
    const auto fail_all = [&] {
        database_->run(
            "SET search_path TO tunewright; WITH gone AS (DELETE FROM waiting RETURNING seq) INSERT INTO ended (seq, "
            "single, status, attempts, cancel_requested, finished_at) SELECT seq, true, 'failed', 0, false, 1 FROM "
            "gone");
    };
    const auto unique_job = [&](const std::string& id, int i) {
        NewJob made = job(id);
        if (i % 3 == 0) return made;  // a third has no key
        made.unique = true;
        made.request_hash = std::to_string(i);
        made.idempotency_key = " unique " + std::to_string(i);
        made.flow = "flow" + std::to_string(i % 5);
        made.client_limit = 1000;
        return made;
    };
    for (int i = 0; i < kinds; i++) {
        const NewJob made = unique_job("job" + std::to_string(i), i);
        completed<Accepted>([&](auto done) { one->accept(made, done); });
    }
    const auto requeue_all = [&](JobStore& store, int round, bool backwards) {
        std::vector<std::promise<void>> answers(2 * kinds);
        const auto answered = [&answers](int at) {
            return [&answers, at](const auto& outcome) {
                EXPECT_FALSE(std::holds_alternative<StoreFault>(outcome));
                answers[static_cast<std::size_t>(at)].set_value();
            };
        };
        for (int i = 0; i < kinds; i++) {
            const int kind = backwards ? kinds - 1 - i : i;
            store.requeue("job" + std::to_string(kind), answered(i));
            const std::string id = (backwards ? "b" : "a") + std::to_string(round) + "-" + std::to_string(kind);
            store.accept(unique_job(id, (kind + 5) % kinds), answered(kinds + i));
        }
        for (auto& answer : answers) answer.get_future().get();
    };
    for (int round = 0; round < rounds; round++) {
        fail_all();
        {
            const std::jthread a([&] { requeue_all(*one, round, false); });
            const std::jthread b([&] { requeue_all(*two, round, true); });
        }
        EXPECT_EQ(database_->run("SELECT count(*) FROM tunewright.waiting w JOIN tunewright.jobs j ON j.seq = w.seq "
                                 "WHERE starts_with(j.idempotency_key, ' unique ')"),
                  std::to_string(kinds - kinds / 3))
            << round << ": of each key one job waits";
    }
    // Its counts come a second late.
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    EXPECT_EQ(database_->run("SELECT deadlocks FROM pg_stat_database WHERE datname = current_database()"), "0");
}

}  // namespace
}  // namespace tunewright::server
