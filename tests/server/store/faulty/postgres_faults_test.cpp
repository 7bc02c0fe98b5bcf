// The PostgreSQL store with a connection that is cut at any one of its messages, before the message or its answer
// arrives: reported results exist, refused ones do not, and the next call works.
#include <gtest/gtest.h>

#include <chrono>
#include <regex>
#include <string>
#include <thread>

#include "server/store/open_store.h"
#include "server/store/postgres/postgres_store.h"
#include "tests/server/store/faulty/bookkeeper.h"
#include "tests/server/store/faulty/cut_line.h"
#include "tests/server/store/postgres_place.h"

namespace tunewright::server {
namespace {

class PostgresFaults : public testing::TestWithParam<CutLine::When> {};

TEST_P(PostgresFaults, AtAnyMessageLoseNothing) {
    const auto database = PostgresDatabase::make();
    if (!database) GTEST_SKIP() << "there is no PostgreSQL: tests/server/postgres.py run -- PROGRAM starts one";
    constexpr int jobs = 8;
    const int points = fault_points(500);
    const std::regex port(":([0-9]+)/");
    std::smatch found;
    const std::string url = database->url();
    ASSERT_TRUE(std::regex_search(url, found, port));
    CutLine line(std::stoi(found[1]));
    const std::string through = std::regex_replace(url, port, ":" + std::to_string(line.port()) + "/");
    open_postgres_store(url, SchemaSteps::take);
    std::int64_t messages = 1;
    int number = 0;
    for (int point = 0; point < points; ++point) {
        const std::int64_t at = point * 7 % messages;
        database->run("TRUNCATE tunewright.jobs, tunewright.waiting, tunewright.running, tunewright.ended");
        const auto store = open_postgres_store(through, SchemaSteps::leave);
        Bookkeeper keeper(*store);
        line.cut(at, GetParam());
        for (int i = 0; i < jobs; ++i) keeper.live(number++);
        messages = std::max(messages, line.messages());
        line.cut(-1, GetParam());
        for (int wait = 0; wait < 500 && !store->healthy(); ++wait)
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        keeper.live(++number);
        EXPECT_TRUE(keeper.there().contains("job" + std::to_string(number)) || number % 3 == 0) << at;
        ++number;
        expect_kept(*store, keeper.there(), "at message " + std::to_string(at));
        for (const std::string& id : keeper.refused())
            EXPECT_FALSE(store->find(id)) << id << " was refused at message " << at;
    }
    EXPECT_GT(messages, 3 * jobs);
}

INSTANTIATE_TEST_SUITE_P(Each, PostgresFaults, testing::Values(CutLine::When::before, CutLine::When::after));

}  // namespace
}  // namespace tunewright::server
