// The jobs that this process has, from their claim to their end in the store: what is asked to stop and shown
// as running.
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

/// One claim of one job. Its parts may be used from every thread.
class HeldJob {
public:
    using Clock = std::chrono::steady_clock;
    enum class Stage {
        ready,      ///< claimed, no worker has begun
        computing,  ///< a worker is at it
        ending,     ///< computed: the store has still to take what came out
    };
    enum class Stop {
        none,
        cancel,    ///< somebody asked
        timeout,   ///< its time is over
        shutdown,  ///< this process ends: it is queued again
        lost,      ///< another has it: whatever comes out is dropped
        dropped,   ///< so has been its batch, with all its jobs
    };

    HeldJob(JobRecord claimed, bool in_front) : job(std::move(claimed)), goes_first(in_front) {}

    const JobRecord job;
    const bool goes_first;  ///< before entries of batches: a single job, or one whose turn has come
    const Clock::time_point claimed_at = Clock::now();

    /// The first reason counts.
    void request(Stop why);
    Stop why() const;
    std::stop_token token() const { return stop_.get_token(); }

    Stage stage() const;
    void enter(Stage stage);

    void report(const Progress& progress);
    std::optional<Progress> progress() const;
    /// Counts reports; 0 before the first.
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
    /// Where the same job is held already, that was an earlier attempt which has been lost: it is stopped.
    std::shared_ptr<HeldJob> add(JobRecord claimed, bool goes_first);
    /// Nothing where that id is held by a later attempt now.
    void forget(const std::shared_ptr<HeldJob>& held);

    std::shared_ptr<HeldJob> find(const std::string& id) const;
    std::vector<std::shared_ptr<HeldJob>> all() const;
    std::size_t size() const;
    /// False where some are held still when `patience` is over.
    bool wait_until_none(std::chrono::duration<double> patience);

private:
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::map<std::string, std::shared_ptr<HeldJob>> jobs_;
};

}  // namespace tunewright::server
