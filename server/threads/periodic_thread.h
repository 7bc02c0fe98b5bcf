// A thread that does the same thing again and again, with pauses, and at once when it is asked to.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace tunewright::server {

class PeriodicThread {
public:
    /// `beat` returns how long to pause; it must not throw. The first beat comes at once.
    explicit PeriodicThread(std::function<std::chrono::milliseconds()> beat);
    ~PeriodicThread() { stop(); }
    PeriodicThread(const PeriodicThread&) = delete;
    PeriodicThread& operator=(const PeriodicThread&) = delete;

    /// The next beat begins now, or again after the one that is going on.
    void wake();
    /// No beat runs after it returns.
    void stop();

private:
    void work(const std::stop_token& stop);

    std::function<std::chrono::milliseconds()> beat_;
    std::mutex mutex_;
    std::condition_variable_any changed_;
    bool woken_ = false;
    std::jthread thread_;
};

}  // namespace tunewright::server
