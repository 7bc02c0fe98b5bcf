// Pauses between attempts, with a constant clock, and the threads that deliver.
#include "server/notify/schedule.h"

#include <gtest/gtest.h>

#include <atomic>
#include <future>

#include "server/notify/delivery_pool.h"

namespace tunewright::server {
namespace {

using namespace std::chrono_literals;
using Pause = std::optional<std::chrono::milliseconds>;

constexpr UnixMs kEnd = 1'700'000'000'000;
constexpr UnixMs kHour = 3'600'000;

TEST(Schedule, GrowsFromSecondsToHours) {
    const std::chrono::milliseconds pauses[] = {5s, 5min, 30min, 2h, 5h, 10h};
    for (int tries = 0; tries < 6; tries++) {
        EXPECT_EQ(pause_after({tries, kEnd, kEnd}), Pause(pauses[tries])) << tries;
        EXPECT_EQ(pause_after({tries, kEnd, kEnd, 0}), Pause(pauses[tries] * 9 / 10)) << tries;
        EXPECT_EQ(pause_after({tries, kEnd, kEnd, 1}), Pause(pauses[tries] * 11 / 10)) << tries;
    }
    EXPECT_EQ(pause_after({7, kEnd, kEnd}), Pause(10h));
    EXPECT_EQ(pause_after({1'000'000, kEnd, kEnd}), Pause(10h));
}

TEST(Schedule, EndsADayAfterTheEndWithALastTry) {
    UnixMs now = kEnd;
    int tries = 0;
    for (; tries < 100; tries++) {
        const Pause pause = pause_after({tries, kEnd, now});
        if (!pause) break;
        now += pause->count();
    }
    EXPECT_EQ(now, kEnd + 24 * kHour);
    EXPECT_EQ(tries, 7);
    // A service that was down for two days makes one attempt.
    EXPECT_EQ(pause_after({0, kEnd, kEnd + 48 * kHour}), std::nullopt);
}

TEST(Schedule, ANoteThatIsLeftToOthersIsLookedAtLessAndLessOften) {
    UnixMs now = kEnd;
    int looks = 0, in_the_first_minute = 0;
    for (Pause pause = 0ms; (pause = pause_for_others({0, kEnd, now}, 1s)) && looks < 10'000; looks++) {
        EXPECT_GE(*pause, now < kEnd + 24 * kHour - 1000 ? 1s : 0ms);
        EXPECT_LE(*pause, 5min);
        now += pause->count();
        in_the_first_minute += now < kEnd + 60'000 ? 1 : 0;
    }
    EXPECT_EQ(now, kEnd + 24 * kHour);
    EXPECT_GE(in_the_first_minute, 10) << "whoever may send it finds it soon";
    EXPECT_LE(looks, 400) << "it was one a second";
    EXPECT_EQ(pause_for_others({0, kEnd, kEnd, 0}, 1s), Pause(900ms));
    EXPECT_EQ(pause_for_others({0, kEnd, kEnd, 1}, 1s), Pause(1100ms));
    EXPECT_EQ(pause_for_others({0, kEnd, kEnd + 48 * kHour}, 1s), std::nullopt);
}

TEST(Schedule, RespectsWhatTheReceiverAsksForUpToAnHour) {
    EXPECT_EQ(pause_after({0, kEnd, kEnd, 0.5, 60s}), Pause(60s));
    EXPECT_EQ(pause_after({0, kEnd, kEnd, 0.5, 1s}), Pause(5s));
    EXPECT_EQ(pause_after({0, kEnd, kEnd, 0.5, 86400s}), Pause(1h));
    EXPECT_EQ(pause_after({3, kEnd, kEnd, 0.5, 86400s}), Pause(2h));
}

TEST(Schedule, ReadsRetryAfter) {
    const UnixMs now = 1'445'412'420'000;  // Wed, 21 Oct 2015 07:27:00 GMT
    EXPECT_EQ(read_retry_after("120", now), 120s);
    EXPECT_EQ(read_retry_after("0", now), 0s);
    EXPECT_EQ(read_retry_after("Wed, 21 Oct 2015 07:28:00 GMT", now), 60s);
    EXPECT_EQ(read_retry_after("Wed, 21 Oct 2015 07:00:00 GMT", now), 0s);
    for (const char* text : {"", "-1", "soon", "1.5", "Wed, 21 Oct 2015", "12 s", "99999999999999999999999"})
        EXPECT_EQ(read_retry_after(text, now), std::nullopt) << text;
}

/// Tasks that wait until they are released.
class LanesTest : public testing::Test {
protected:
    bool add(const std::string& machine) {
        return lanes_.add({machine, DeliveryPool::Clock::now() + 1min, [this, machine] {
                               ++begun_;
                               gate_.wait();
                           }});
    }
    void wait_for(int begun) const {
        for (int i = 0; i < 500 && begun_ < begun; i++) std::this_thread::sleep_for(10ms);
    }

    std::atomic<int> begun_ = 0;
    std::promise<void> open_;
    std::shared_future<void> gate_ = open_.get_future().share();
    DeliveryPool lanes_;
};

TEST_F(LanesTest, OneMachineHoldsUpNoOther) {
    for (int i = 0; i < 20; i++) EXPECT_TRUE(add("slow"));
    wait_for(2);
    EXPECT_TRUE(add("other"));
    wait_for(3);
    std::this_thread::sleep_for(50ms);
    EXPECT_EQ(begun_, 3);
    open_.set_value();
    wait_for(21);
    EXPECT_EQ(begun_, 21);
    EXPECT_TRUE(lanes_.stop(5s));
    EXPECT_FALSE(add("late"));
}

TEST_F(LanesTest, EightRunAndTheRoomIsBounded) {
    std::size_t added = 0;
    for (int i = 0; i < 300; i++) added += add("m" + std::to_string(i)) ? 1U : 0U;
    wait_for(8);
    std::this_thread::sleep_for(50ms);
    EXPECT_EQ(begun_, 8);
    EXPECT_GE(added, DeliveryPool::kMaxWaiting);
    EXPECT_LE(added, DeliveryPool::kMaxWaiting + DeliveryPool::kThreads);
    EXPECT_FALSE(lanes_.stop(50ms));
    open_.set_value();
    EXPECT_TRUE(lanes_.stop(5s));
    EXPECT_EQ(begun_, 8);
}

TEST_F(LanesTest, WhatIsSlowKeepsFewWaiting) {
    for (int i = 0; i < 10; i++) add("slow");
    wait_for(2);
    std::this_thread::sleep_for(DeliveryPool::kSlowTime + 100ms);
    open_.set_value();
    for (int i = 0; i < 500 && lanes_.size() > 0; i++) std::this_thread::sleep_for(10ms);
    EXPECT_LE(begun_, 6);
    EXPECT_GE(begun_, 3);
}

TEST_F(LanesTest, WhatWaitedForTooLongIsNotBegun) {
    open_.set_value();
    EXPECT_TRUE(lanes_.add({"m", DeliveryPool::Clock::now() - 1s, [this] { ++begun_; }}));
    for (int i = 0; i < 500 && lanes_.size() > 0; i++) std::this_thread::sleep_for(10ms);
    EXPECT_EQ(begun_, 0);
}

}  // namespace
}  // namespace tunewright::server
