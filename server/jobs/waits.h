// Waits for the end of a job: a callback and a timer each, no thread.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "server/store/archive.h"
#include "server/threads/timer.h"

namespace tunewright::server {

/// Runs once: with the job if it ended in this process, which saves reading it again; otherwise with null.
using WaitEnd = std::function<void(const std::shared_ptr<const JobRecord>& job)>;

class Waits {
public:
    /// The timer must have been stopped before the waits are destroyed.
    explicit Waits(Timer& timer) : timer_(timer) {}

    /// Calls `ended` once: when notify() names the job, or after `wait`.
    void add(const std::string& id, std::chrono::duration<double> wait, WaitEnd ended);
    /// The job has ended.
    void notify(const std::string& id) { tell(take(id), nullptr); }
    /// The job has ended; `job` makes the record, if somebody waits.
    void notify(const std::string& id, const std::function<JobRecord()>& job);
    /// Ends all waits.
    void tell_all();
    /// The ids of all jobs with a wait, each once.
    std::vector<std::string> ids() const;

private:
    struct Waiter {
        WaitEnd ended;
        Timer::Key timeout;
    };
    using Waiters = std::vector<std::shared_ptr<Waiter>>;
    Waiters take(const std::string& id);
    void tell(const Waiters& waiters, const std::shared_ptr<const JobRecord>& job);

    Timer& timer_;
    mutable std::mutex mutex_;
    std::multimap<std::string, std::shared_ptr<Waiter>> waiters_;
};

}  // namespace tunewright::server
