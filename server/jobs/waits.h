// Who waits for the end of a job: a callback and a timer each, no thread.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "server/jobs/timer.h"

namespace tunewright::server {

class Waits {
public:
    /// The timer must have been stopped before the waits go.
    explicit Waits(Timer& timer) : timer_(timer) {}

    /// Calls `ended` once: when notify() names the job, or after `wait`.
    void add(const std::string& id, std::chrono::duration<double> wait, std::function<void()> ended);
    /// That job has ended.
    void notify(const std::string& id);
    /// Nobody waits any longer.
    void tell_all();
    /// The jobs that are waited for, each once.
    std::vector<std::string> ids() const;

private:
    struct Waiter {
        std::function<void()> ended;
        Timer::Key timeout;
    };

    Timer& timer_;
    mutable std::mutex mutex_;
    std::multimap<std::string, std::shared_ptr<Waiter>> waiters_;
};

}  // namespace tunewright::server
