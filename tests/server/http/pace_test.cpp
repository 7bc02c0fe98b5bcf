#include "server/http/pace.h"

#include <gtest/gtest.h>

namespace tunewright::server::http {
namespace {

using namespace std::chrono_literals;

constexpr Pace::Time kStart{1h};

TEST(Pace, EndsAWindowAfterTheWaitBegan) {
    Pace pace(100, 10s);
    EXPECT_FALSE(pace.waiting());
    pace.wait(kStart);
    pace.wait(kStart + 5s);
    EXPECT_TRUE(pace.waiting());
    EXPECT_EQ(pace.end(), kStart + 10s);
}

TEST(Pace, GivesAFreshWindowOnlyForEnoughBytes) {
    Pace pace(100, 10s);
    pace.wait(kStart);
    pace.arrived(99, kStart + 9s);
    pace.wait(kStart + 20s);
    EXPECT_EQ(pace.end(), kStart + 21s);
    pace.arrived(1, kStart + 20s + 500ms);
    pace.wait(kStart + 30s);
    EXPECT_EQ(pace.end(), kStart + 40s);
}

TEST(Pace, CountsOnlyTheTimeInWhichWeWait) {
    Pace pace(100, 10s);
    pace.wait(kStart);
    pace.arrived(1, kStart + 1s);
    EXPECT_FALSE(pace.waiting());
    pace.arrived(1, kStart + 1000s);
    pace.wait(kStart + 2000s);
    EXPECT_EQ(pace.end(), kStart + 2009s);
}

}  // namespace
}  // namespace tunewright::server::http
