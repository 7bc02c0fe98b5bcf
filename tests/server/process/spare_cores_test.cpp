
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <thread>
#include <vector>

#include "server/threads/spare_cores.h"

namespace tunewright::server {
namespace {

using namespace std::chrono_literals;

/// Detects whether two calls are in progress at the same time: each waits for the other, for a while.
class Meeting {
public:
    explicit Meeting(std::chrono::milliseconds patience) : patience_(patience) {}

    void come() {
        std::unique_lock lock(mutex_);
        here_++;
        changed_.notify_all();
        met_ = changed_.wait_for(lock, patience_, [this] { return here_ > 1; }) || met_;
    }
    bool met() const { return met_; }

private:
    const std::chrono::milliseconds patience_;
    std::mutex mutex_;
    std::condition_variable changed_;
    int here_ = 0;
    bool met_ = false;
};

TEST(SpareCores, EachPieceIsDoneOnce) {
    SpareCores cores(4);
    SpareCores::Computation computation(cores);
    for (int round = 0; round < 200; ++round) {
        std::vector<int> done(static_cast<std::size_t>(round), 0);
        computation.spread()(round, [&](int i) { done[static_cast<std::size_t>(i)]++; });
        EXPECT_EQ(done, std::vector<int>(static_cast<std::size_t>(round), 1));
    }
}

TEST(SpareCores, AFreeCoreHelps) {
    SpareCores cores(2);
    SpareCores::Computation computation(cores);
    Meeting meeting(10s);
    computation.spread()(2, [&](int) { meeting.come(); });
    EXPECT_TRUE(meeting.met());
}

TEST(SpareCores, NoneIsTakenFromAnotherComputation) {
    SpareCores cores(2);
    SpareCores::Computation computation(cores), another(cores);
    const auto here = std::this_thread::get_id();
    computation.spread()(20, [&](int) { EXPECT_EQ(std::this_thread::get_id(), here); });
}

TEST(SpareCores, AHelperLeavesWhatAnotherComputationNeeds) {
    SpareCores cores(2);
    SpareCores::Computation computation(cores);
    std::optional<SpareCores::Computation> another;
    const auto here = std::this_thread::get_id();
    Meeting meeting(10s);
    std::atomic<int> elsewhere = 0;
    computation.spread()(22, [&](int i) {
        if (i < 2) meeting.come();
        if (i == 0) another.emplace(cores);
        if (i > 2 && std::this_thread::get_id() != here) elsewhere++;
        std::this_thread::sleep_for(2ms);
    });
    EXPECT_TRUE(meeting.met());
    EXPECT_LE(elsewhere, 1);
}

TEST(SpareCores, SpreadWithinSpreadEnds) {
    SpareCores cores(3);
    SpareCores::Computation computation(cores);
    std::atomic<int> pieces = 0;
    computation.spread()(8, [&](int) { computation.spread()(8, [&](int) { pieces++; }); });
    EXPECT_EQ(pieces, 64);
}

TEST(SpareCores, WhatAPieceThrowsIsThrownOnceTheOthersHaveReturned) {
    SpareCores cores(2);
    SpareCores::Computation computation(cores);
    std::atomic<int> returned = 0;
    const auto one_fails = [&](int i) {
        if (i == 3) throw std::runtime_error("no");
        returned++;
    };
    EXPECT_THROW(computation.spread()(10, one_fails), std::runtime_error);
    EXPECT_EQ(returned, 9);
}

}  // namespace
}  // namespace tunewright::server
