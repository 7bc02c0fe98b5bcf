// A few threads for tasks that wait for other machines: eight at a time, two per machine, so that a slow machine delays
// only its own tasks.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace tunewright::server {

class DeliveryPool {
public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::size_t kThreads = 8, kMaxPerMachine = 2;
    static constexpr std::size_t kMaxWaiting = 128;  ///< tasks that may wait
    /// A machine for which a task took this long is slow until one is quicker; only
    /// kMaxWaitingOfSlow tasks wait for it.
    static constexpr std::chrono::seconds kSlowTime{1};
    static constexpr std::size_t kMaxWaitingOfSlow = 2;

    struct Task {
        std::string machine;
        Clock::time_point latest;  ///< the task is dropped if it has not begun by then
        std::function<void()> run;
    };

    ~DeliveryPool() { stop(std::chrono::seconds(0)); }

    std::size_t room() const;
    /// Tasks that wait or run.
    std::size_t size() const;
    /// False if it is dropped: no room, no room for its machine, or the pool has stopped.
    bool add(Task task);
    /// Drops waiting tasks. True if all running ones have ended within `patience`; otherwise the pool must not be
    /// destroyed.
    bool stop(std::chrono::milliseconds patience);

private:
    struct Machine {
        std::size_t waiting = 0, running = 0;
        bool slow = false;
    };

    void grow();
    void work();
    bool pick(Task& task);
    void took(const std::string& machine, Clock::duration time);
    void forget_idle(const std::string& machine);

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Task> waiting_;
    std::map<std::string, Machine> machines_;  ///< those with tasks, and slow ones
    std::size_t running_ = 0;
    bool stopping_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace tunewright::server
