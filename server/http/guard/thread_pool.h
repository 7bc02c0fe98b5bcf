// A pool of threads that are started when there is work and end after a time without work.
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

    /// Ends the threads when they have done the posted work; false if that takes longer.
    bool stop_within(std::chrono::milliseconds patience);

    /// Runs the task on a new thread, or when one of `max` is free. Exceptions are logged. False if the system has no
    /// more threads, so that the task waits for an existing one.
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
