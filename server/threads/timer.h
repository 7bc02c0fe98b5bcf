// Runs actions at their time, on one thread: deadlines of jobs, ends of waits.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <thread>

namespace tunewright::server {

class Timer {
public:
    using Key = std::pair<std::chrono::steady_clock::time_point, std::uint64_t>;

    Timer();
    ~Timer();
    Timer(const Timer&) = delete;
    Timer& operator=(const Timer&) = delete;

    /// The action must be quick and must not throw.
    Key after(std::chrono::duration<double> delay, std::function<void()> action);
    void cancel(const Key& key);
    /// No action runs after it returns, including later ones.
    void stop();

private:
    void work();

    std::mutex mutex_;
    std::condition_variable changed_;
    std::map<Key, std::function<void()>> actions_;
    std::uint64_t next_ = 0;
    bool stopping_ = false;
    std::jthread thread_;
};

}  // namespace tunewright::server
