// The jobs that this process holds, from their claim to their end in the store: for stop requests and for progress.
#pragma once

#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "engine/progress.h"
#include "server/store/archive.h"

namespace tunewright::server {

/// One claim of one job. May be used from every thread.
class HeldJob {
public:
    using Clock = std::chrono::steady_clock;
    enum class Stage {
        ready,      ///< claimed, not begun by a worker
        computing,  ///< a worker computes it
        ending,     ///< computed: the result is not stored yet
    };
    enum class Stop {
        none,
        cancel,    ///< a cancellation was requested
        timeout,   ///< its time limit is over
        shutdown,  ///< this process ends: it is queued again
        lost,      ///< another process has it: the result is dropped
        dropped,   ///< its batch was dropped with all its jobs
    };

    HeldJob(JobRecord claimed, bool in_front) : job(std::move(claimed)), goes_first(in_front) {}

    const JobRecord job;
    const bool goes_first;  ///< before entries of batches: a single job, or a low-priority job claimed first
    const Clock::time_point claimed_at = Clock::now();

    /// The first reason is kept.
    void request(Stop why);
    Stop why() const;
    std::stop_token token() const { return stop_.get_token(); }

    Stage stage() const;
    void enter(Stage stage);

    void report(const Progress& progress);
    std::optional<Progress> progress() const;
    /// Number of reports; 0 before the first.
    unsigned revision() const;

private:
    std::stop_source stop_;
    mutable std::mutex mutex_;
    Stage stage_ = Stage::ready;
    Stop reason_ = Stop::none;
    std::optional<Progress> progress_;
    unsigned revision_ = 0;
};

class HeldJobs {
public:
    /// If the same job is already held, that was an earlier attempt, now lost: it is stopped.
    std::shared_ptr<HeldJob> add(JobRecord claimed, bool goes_first);
    /// Does nothing if a later attempt of that job is held now.
    void forget(const std::shared_ptr<HeldJob>& held);

    std::shared_ptr<HeldJob> find(const std::string& id) const;
    std::vector<std::shared_ptr<HeldJob>> all() const;
    std::size_t size() const;
    /// False if some are still held when `patience` is over.
    bool wait_until_none(std::chrono::duration<double> patience);

private:
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::string, std::shared_ptr<HeldJob>> jobs_;
};

}  // namespace tunewright::server
