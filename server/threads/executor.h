// A fixed set of threads that run what is posted, in order.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace tunewright::server {

class Executor {
public:
    /// `niceness` > 0 lets other threads of the process go first when cores are short.
    explicit Executor(std::size_t threads, int niceness = 0);
    ~Executor();
    Executor(const Executor&) = delete;
    Executor& operator=(const Executor&) = delete;

    /// Runs what is queued, then joins; what is posted later is dropped.
    void stop();

    /// False where none is taken any more. What the task throws is logged.
    bool post(std::function<void()> task);
    /// Runs the task there and waits for it. False where none is taken any more. Throws what the task throws.
    bool run(std::function<void()> task);

    /// Posted and not begun.
    std::size_t waiting() const;

private:
    void work();

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> tasks_;
    bool stopping_ = false;
    std::vector<std::jthread> threads_;
};

/// Lowers the priority of the calling thread alone.
void be_nice(int niceness);

}  // namespace tunewright::server
