// A fixed set of threads that run posted tasks, in order.
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
    /// `niceness` > 0 gives other threads of the process priority when all cores are busy.
    explicit Executor(std::size_t threads, int niceness = 0);
    ~Executor();
    Executor(const Executor&) = delete;
    Executor& operator=(const Executor&) = delete;

    /// Runs the queued tasks, then joins; tasks posted later are dropped.
    void stop();

    /// False after stop(). Exceptions of the task are logged.
    bool post(std::function<void()> task);
    /// Runs the task on a thread of the executor and waits for it. False after stop(). Rethrows exceptions of the task.
    bool run(std::function<void()> task);

    /// Number of tasks posted but not begun.
    std::size_t waiting() const;

private:
    void work();

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<std::function<void()>> tasks_;
    bool stopping_ = false;
    std::vector<std::jthread> threads_;
};

/// Lowers the priority of the calling thread only.
void be_nice(int niceness);

}  // namespace tunewright::server
