// A few threads that run tasks which wait for others' machines: eight at a time, two for each of those, so that a slow
// one holds up nobody but those who wait for it.
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
    /// A machine for which a task took so long is slow until one is quicker; no more than so many wait for it.
    static constexpr std::chrono::seconds kSlowTime{1};
    static constexpr std::size_t kMaxWaitingOfSlow = 2;

    struct Task {
        std::string machine;
        Clock::time_point latest;  ///< it is dropped where it has not begun by then
        std::function<void()> run;
    };

    ~DeliveryPool() { stop(std::chrono::seconds(0)); }

    std::size_t room() const;
    /// Tasks that wait or run.
    std::size_t size() const;
    /// False where it is dropped: no room, none for its machine, or all has been stopped.
    bool add(Task task);
    /// Drops what waits. True where all that runs has ended within `patience`; else it is not to be destroyed.
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
    std::map<std::string, Machine> machines_;  ///< those with tasks, and the slow ones
    std::size_t running_ = 0;
    bool stopping_ = false;
    std::vector<std::thread> threads_;
};

}  // namespace tunewright::server
