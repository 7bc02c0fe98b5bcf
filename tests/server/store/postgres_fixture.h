// A store on PostgreSQL, with its database for direct access.
#pragma once

#include <thread>

#include "server/store/open_store.h"
#include "server/store/postgres/postgres_store.h"
#include "tests/server/store/postgres_place.h"
#include "tests/server/store/store_conformance.h"

namespace tunewright::server {

class PostgresStore : public testing::Test {
protected:
    void SetUp() override {
        database_ = PostgresDatabase::make();
        if (!database_) GTEST_SKIP() << "there is no PostgreSQL: tests/server/postgres.py run -- PROGRAM starts one";
    }
    std::unique_ptr<JobStore> open() { return open_postgres_store(database_->url(), SchemaSteps::take); }
    static NewJob job(const std::string& id) {
        NewJob made;
        made.id = id;
        made.request = "{}";
        made.request_hash = "hash";
        made.created_at = 1000;
        return made;
    }
    static bool accept(JobStore& store, const std::string& id) {
        const NewJob made = job(id);
        return completed<Accepted>([&](auto done) { store.accept(made, done); }).kind == Accepted::Kind::created;
    }
    static std::vector<JobRecord> claim(JobStore& store, std::size_t max = 1) {
        const Claim claim{"worker", 2000, std::chrono::minutes(10), max};
        return completed<std::vector<JobRecord>>([&](auto done) { store.claim(claim, done); });
    }
    /// Waits until the query is true. Throws if it is not within a minute.
    void wait_until(const std::string& question) const {
        const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
        while (database_->run(question) != "t") {
            if (std::chrono::steady_clock::now() > end) throw std::runtime_error("never came true: " + question);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
    }
    static void wait_until_healthy(const JobStore& store) {
        while (!store.healthy()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }

    std::unique_ptr<PostgresDatabase> database_;
};

}  // namespace tunewright::server
