// A thread that repeats an action, with pauses, and at once after a wake-up.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace tunewright::server {

class PeriodicThread {
public:
    /// `beat` returns the pause; it must not throw. The first beat comes at once.
    explicit PeriodicThread(std::function<std::chrono::milliseconds()> beat);
    ~PeriodicThread() { stop(); }
    PeriodicThread(const PeriodicThread&) = delete;
    PeriodicThread& operator=(const PeriodicThread&) = delete;

    /// The next beat begins now, or after the one in progress.
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
