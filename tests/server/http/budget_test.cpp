// Requests that need more memory than the total, and the one that gives way.
#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "server/http/guard/budget.h"

namespace tunewright::server::http {
namespace {

using namespace std::chrono_literals;

TEST(Budget, TheLargestArrivingRequestOfWhoHoldsMostGivesWay) {
    Budget budget(200);
    std::atomic<int> asked = 0;
    Budget::Reservation small = budget.open("greedy", [&] { asked = 1; });
    Budget::Reservation large = budget.open("greedy", [&] { asked = 2; });
    Budget::Reservation whole = budget.open("greedy", [&] { asked = 3; });
    ASSERT_TRUE(small.grow(10, 0ms) && large.grow(30, 0ms) && whole.grow(40, 0ms) && whole.arrived(0, 0ms));
    Budget::Reservation other = budget.open("modest", [] {});
    std::thread leaves([&] {
        while (asked == 0) std::this_thread::sleep_for(1ms);
        EXPECT_FALSE(large.grow(1, 0ms)) << "it has been asked to give way";
        large = {};
    });
    EXPECT_TRUE(other.grow(70, 5s));
    leaves.join();
    EXPECT_EQ(asked, 2);
    EXPECT_EQ(budget.taken(), 120U);
}

TEST(Budget, WhoHoldsMostWaitsForItsOwnUnlessOneIsTwiceAsLarge) {
    Budget budget(200);
    std::atomic<bool> asked = false;
    const auto ask = [&] { asked = true; };
    Budget::Reservation first = budget.open("greedy", ask);
    Budget::Reservation second = budget.open("greedy", ask);
    Budget::Reservation other = budget.open("modest", ask);
    ASSERT_TRUE(first.grow(60, 0ms) && other.grow(30, 0ms));
    EXPECT_FALSE(second.grow(31, 10ms));
    EXPECT_FALSE(asked);
    std::thread ends([&] {
        while (!asked) std::this_thread::sleep_for(1ms);
        first = {};
    });
    EXPECT_TRUE(second.grow(20, 5s)) << "a stalled large body would keep its own client's small ones from coming";
    ends.join();
}

TEST(Budget, RequestsThatWaitToBeAnsweredLeaveRoomForOneThatIs) {
    Budget budget(200);
    std::vector<Budget::Reservation> all;
    for (int i = 0; i < 5; ++i) {
        all.push_back(budget.open("one", [] {}));
        ASSERT_TRUE(all.back().grow(20, 0ms));
    }
    EXPECT_TRUE(all[0].arrived(1000, 0ms)) << "more than half of the whole counts as half";
    EXPECT_FALSE(all[1].arrived(50, 0ms));
    all[0] = {};
    EXPECT_TRUE(all[1].arrived(50, 0ms));
}

TEST(Budget, WhatIsBeingAnsweredKeepsNoBodyFromArriving) {
    Budget budget(200);
    Budget::Reservation computing = budget.open("greedy", [] {});
    ASSERT_TRUE(computing.grow(90, 0ms) && computing.arrived(1000, 0ms));
    Budget::Reservation other = budget.open("modest", [] {});
    EXPECT_TRUE(other.grow(100, 0ms));
}

TEST(Budget, WhoHoldsMuchThatIsAnsweredShieldsNobodyElsesBodies) {
    Budget budget(200);
    std::atomic<bool> asked = false;
    Budget::Reservation computing = budget.open("one", [] {});
    ASSERT_TRUE(computing.grow(100, 0ms) && computing.arrived(1000, 0ms));
    Budget::Reservation stalled = budget.open("two", [&] { asked = true; });
    ASSERT_TRUE(stalled.grow(80, 0ms));
    Budget::Reservation other = budget.open("three", [] {});
    std::thread leaves([&] {
        while (!asked) std::this_thread::sleep_for(1ms);
        stalled = {};
    });
    EXPECT_TRUE(other.grow(60, 5s));
    leaves.join();
}

TEST(Budget, OneThatWaitsForRoomIsWokenToGiveWay) {
    Budget budget(200);
    Budget::Reservation first = budget.open("greedy", [] {}), second = budget.open("greedy", [] {});
    ASSERT_TRUE(first.grow(30, 0ms) && second.grow(40, 0ms));
    std::thread waits([&] {
        EXPECT_FALSE(second.grow(40, 60s));
        second = {};
    });
    std::this_thread::sleep_for(50ms);
    Budget::Reservation other = budget.open("modest", [] {});
    EXPECT_TRUE(other.grow(40, 30s));
    waits.join();
}

TEST(Budget, OneThatDoesNotLeaveIsNotTheOnlyOneAsked) {
    Budget budget(200);
    std::atomic<bool> asked = false;
    Budget::Reservation stays = budget.open("greedy", [] {}), leaves = budget.open("greedy", [&] { asked = true; });
    ASSERT_TRUE(stays.grow(50, 0ms) && leaves.grow(40, 0ms));
    std::thread left([&] {
        while (!asked) std::this_thread::sleep_for(1ms);
        leaves = {};
    });
    Budget::Reservation other = budget.open("modest", [] {});
    EXPECT_TRUE(other.grow(30, 30s));
    left.join();
}

TEST(Budget, WhatIsNeededNoLongerIsThereForOthers) {
    Budget budget(51'200);
    Budget::Reservation first = budget.open("one", [] {}), second = budget.open("two", [] {});
    ASSERT_TRUE(first.grow(10'000, 0ms) && first.arrived(15'000, 0ms) && second.grow(10'000, 0ms));
    std::thread ends([&] {
        std::this_thread::sleep_for(20ms);
        first.keep(5'000);
    });
    EXPECT_TRUE(second.arrived(10'000, 30s)) << "woken, not at the end of its patience";
    ends.join();
    EXPECT_EQ(budget.taken(), 25'000U);
    first.keep(50'000);
    EXPECT_EQ(budget.taken(), 25'000U) << "it never grows by that";
}

TEST(Budget, SmallRequestsThatWaitForTheirAnswersKeepNoLargeOneFromItsOwn) {
    Budget budget(51'200);
    std::vector<Budget::Reservation> small;
    for (int i = 0; i < 128; ++i) {
        small.push_back(budget.open("many", [] {}));
        ASSERT_TRUE(small.back().grow(100, 0ms) && small.back().arrived(0, 0ms));
    }
    Budget::Reservation large = budget.open("modest", [] {});
    ASSERT_TRUE(large.grow(20'000, 0ms));
    EXPECT_TRUE(large.arrived(1'000'000, 0ms));
    EXPECT_EQ(budget.taken(), 25'600U + 12'800U);
    small[0].keep(0);
    small[0] = {};
    Budget::Reservation other = budget.open("other", [] {});
    ASSERT_TRUE(other.grow(200, 0ms));
    EXPECT_FALSE(other.arrived(0, 0ms)) << "only the small have that room";
    small.clear();
    large = {};
    other = {};
    EXPECT_EQ(budget.taken(), 0U);
}

TEST(Budget, SmallRequestsHaveRoomWhoeverFillsTheRest) {
    Budget budget(51'200);
    Budget::Reservation large = budget.open("greedy", [] {});
    ASSERT_TRUE(large.grow(30'000, 0ms) && large.arrived(30'000, 0ms));
    std::vector<Budget::Reservation> small;
    for (int i = 0; i < 384; ++i) {
        small.push_back(budget.open("greedy", [] {}));
        EXPECT_TRUE(small.back().grow(100, 0ms));
    }
    EXPECT_FALSE(small.front().grow(1, 0ms));
    EXPECT_EQ(budget.taken(), 25'600U + 25'600U + 12'800U);
    small.clear();
    large = {};
    EXPECT_EQ(budget.taken(), 0U);
}

}  // namespace
}  // namespace tunewright::server::http
