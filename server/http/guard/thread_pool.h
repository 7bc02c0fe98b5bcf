// Threads that come when there is work and go when there is none for a while.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>

namespace tunewright::server::http {

class ThreadPool {
public:
    explicit ThreadPool(std::size_t max) : max_(max) {}
    ~ThreadPool() { stop_within(std::chrono::hours(24)); }
    ThreadPool(const ThreadPool&) = delete;
    ThreadPool& operator=(const ThreadPool&) = delete;

    /// Ends the threads when they have done what was posted; false where that takes longer.
    bool stop_within(std::chrono::milliseconds patience);

    /// Runs the task on a thread of its own, or when one of `max` is free. What it throws is logged. False where the
    /// system gives no more threads, so that it waits for one of those that there are.
    bool post(std::function<void()> task);

private:
    void work();

    const std::size_t max_;
    std::mutex mutex_;
    std::condition_variable posted_;
    std::condition_variable left_;
    std::deque<std::function<void()>> tasks_;
    std::size_t threads_ = 0;
    std::size_t idle_ = 0;
    bool stopping_ = false;
};

}  // namespace tunewright::server::http
