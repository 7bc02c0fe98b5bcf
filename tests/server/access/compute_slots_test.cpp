#include "server/access/compute_slots.h"

#include <gmock/gmock.h>

#include <atomic>
#include <thread>
#include <vector>

#include "server/access/long_request_slots.h"

namespace tunewright::server {
namespace {

using namespace std::chrono_literals;

class TurnsTest : public testing::Test {
protected:
    static ComputeSlots::Clock::time_point far() { return ComputeSlots::Clock::now() + 60s; }

    /// Waits on a thread of its own, and records its name when its turn has come.
    void wait_for_turn(const std::string& client, std::size_t already) {
        threads_.emplace_back([this, client] {
            if (turns_.take(client, far(), {}) != ComputeSlots::Wait::granted) return;
            {
                const std::lock_guard lock(mutex_);
                order_.push_back(client);
            }
            turns_.give_back(client);
        });
        // Waits until the request is in the queue.
        std::this_thread::sleep_for(20ms * (already + 1));
    }

    /// Fills all slots with requests of other clients.
    void fill() {
        ASSERT_EQ(turns_.take("first", far(), {}), ComputeSlots::Wait::granted);
        ASSERT_EQ(turns_.take("second", far(), {}), ComputeSlots::Wait::granted);
    }

    ComputeSlots turns_{1, 1, 8};
    std::mutex mutex_;
    std::vector<std::string> order_;
    std::vector<std::jthread> threads_;
};

TEST_F(TurnsTest, ClientsTakeTurnsHoweverManyOneOfThemAsksFor) {
    fill();
    for (const char* client : {"a", "a", "a", "b", "c"}) wait_for_turn(client, 0);
    turns_.give_back("first");
    threads_.clear();
    EXPECT_THAT(order_, testing::ElementsAre("a", "b", "c", "a", "a"));
}

TEST_F(TurnsTest, OneClientMayHaveHalfOfThoseWhoWait) {
    fill();
    for (std::size_t i = 0; i < 4; i++) wait_for_turn("a", 0);
    EXPECT_EQ(turns_.take("a", far(), {}), ComputeSlots::Wait::full);
    EXPECT_EQ(turns_.take("b", ComputeSlots::Clock::now() + 1ms, {}), ComputeSlots::Wait::late) << "it may wait";
    turns_.give_back("first");
    turns_.give_back("second");
}

TEST_F(TurnsTest, WhoHasLeftOrIsTooLateGivesHisPlaceUp) {
    fill();
    EXPECT_EQ(turns_.take("a", far(), [] { return true; }), ComputeSlots::Wait::left);
    EXPECT_EQ(turns_.take("a", ComputeSlots::Clock::now(), {}), ComputeSlots::Wait::late);
    turns_.give_back("first");
    EXPECT_EQ(turns_.take("b", far(), {}), ComputeSlots::Wait::granted);
    turns_.give_back("b");
}

TEST(ComputeSlots, WhoHasNoneUnderWayGetsOneWhileAnotherFillsThePlaces) {
    ComputeSlots turns(2, 2, 8);
    const auto soon = [] { return ComputeSlots::Clock::now() + 1ms; };
    ASSERT_EQ(turns.take("a", soon(), {}), ComputeSlots::Wait::granted);
    ASSERT_EQ(turns.take("a", soon(), {}), ComputeSlots::Wait::granted);
    EXPECT_EQ(turns.take("a", soon(), {}), ComputeSlots::Wait::late) << "all are taken, by this client";
    EXPECT_EQ(turns.take("b", soon(), {}), ComputeSlots::Wait::granted);
    EXPECT_EQ(turns.take("b", soon(), {}), ComputeSlots::Wait::late) << "it has one";
    EXPECT_EQ(turns.take("c", soon(), {}), ComputeSlots::Wait::granted);
    EXPECT_EQ(turns.take("d", soon(), {}), ComputeSlots::Wait::late) << "as many again, and no more";
    turns.give_back("b");
    EXPECT_EQ(turns.take("a", soon(), {}), ComputeSlots::Wait::late);
    EXPECT_EQ(turns.take("d", soon(), {}), ComputeSlots::Wait::granted);
}

TEST(LongRequestSlots, AreLimitedAltogetherAndForOneClientAndComeBack) {
    LongRequestSlots places({3, 2});
    auto one = places.take("a"), two = places.take("a");
    EXPECT_TRUE(one && two);
    EXPECT_FALSE(places.take("a"));
    auto other = places.take("b");
    EXPECT_TRUE(other);
    EXPECT_FALSE(places.take("c"));
    one.reset();
    EXPECT_TRUE(places.take("c"));
}

}  // namespace
}  // namespace tunewright::server
