// Claims jobs from the store for the workers of this process. One claim is in progress at a time, for as many jobs as
// workers are idle; only if many jobs wait and the latest were short, a few more are claimed ahead, so that no worker
// waits for the store between them, and no process holds many heavy jobs.
//
// A job during which processes have ended more than once runs alone: it is claimed when nothing else is held; after a
// while nothing else is claimed before it, and nothing while it runs. So it takes no other job down with it.
//
// Arrivals are counted: a worker that finds no job sleeps only if nothing has arrived since the store was asked. In a
// shared store the count is also raised every second: notices may be lost, the tables are authoritative.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <vector>

#include "server/jobs/running/held.h"
#include "server/jobs/store_outage_log.h"
#include "server/store/queue.h"

namespace tunewright::server {

struct ClaimSettings {
    std::string worker;  ///< names this process
    std::chrono::milliseconds lease{10'000};
    std::function<UnixMs()> now;
    std::size_t max_held = 64;                        ///< no claim while this many are held, including results not
                                                      ///< stored yet
    std::size_t max_unsaved = std::size_t{64} << 20;  ///< no claim while results of this many bytes wait for the store
    std::function<void(const std::vector<JobRecord>&)> claimed;  ///< called on the store's thread
    std::function<void(std::shared_ptr<HeldJob>)> late;          ///< receives a job that was claimed too late, after
                                                                 ///< close()
};

class Claims {
public:
    /// All references must outlive the claims.
    Claims(JobQueue& queue, HeldJobs& held, StoreOutageLog& outage, ClaimSettings settings);

    /// The next job, once there is one; null after close() or a stop. Jobs are registered before a worker gets them, so
    /// they may already have been asked to stop.
    std::shared_ptr<HeldJob> take(const std::stop_token& stop);
    /// A job was queued, perhaps by another process.
    void arrived();
    /// A computation took this long; not `whole`: it was stopped then.
    void took(double seconds, bool whole = true);
    /// Results of this many bytes wait for the store.
    void unsaved(std::size_t bytes);
    /// Claims again after a failure.
    void retry();
    /// This number of jobs wait that must run alone.
    void suspects(std::size_t waiting);
    /// A held job was released.
    void freed();
    /// Takes back jobs that no worker has begun: those claimed before `before`, or that one. The caller then owns them.
    std::vector<std::shared_ptr<HeldJob>> withdraw(HeldJob::Clock::time_point before);
    bool withdraw(const std::shared_ptr<HeldJob>& held);
    /// No more claims; waits up to `patience` for one in progress. The caller gets the jobs that no worker has begun.
    std::vector<std::shared_ptr<HeldJob>> close(std::chrono::milliseconds patience);

    /// Typical seconds of the latest jobs; 0 before the first.
    double pace() const;

private:
    std::size_t ahead() const;
    std::size_t wanted() const;
    bool urgent() const;
    bool suspects_turn(std::size_t held) const;
    bool keeps_clear(std::size_t held) const;
    void ask(std::unique_lock<std::mutex>& lock);
    void put(std::shared_ptr<HeldJob> held);
    void come(Outcome<std::vector<JobRecord>> outcome, std::size_t asked, bool low_first);

    JobQueue& queue_;
    HeldJobs& held_;
    StoreOutageLog& outage_;
    ClaimSettings settings_;

    mutable std::mutex mutex_;
    std::condition_variable_any changed_;
    std::deque<std::shared_ptr<HeldJob>> ready_;  ///< single jobs first
    std::size_t idle_ = 0;                        ///< workers waiting in take()
    bool asking_ = false;
    bool asking_for_arrivals_ = false;
    bool failed_ = false;  ///< the last claim failed: the next one waits for retry()
    bool closed_ = false;
    std::uint64_t claims_ = 0;    ///< number so far
    bool more_ = false;           ///< the last claim got as many jobs as it asked for
    std::uint64_t arrivals_ = 0;  ///< number so far
    std::uint64_t seen_ = 0;      ///< arrivals when the store was last asked
    std::size_t unsaved_ = 0;
    bool alone_ = false;  ///< the held job must run alone
    bool asking_for_suspects_ = false;
    std::size_t suspects_ = 0;
    HeldJob::Clock::time_point suspects_since_{};
    HeldJob::Clock::time_point last_take_{};
    double pace_ = 0;
    std::size_t streak_ = 0;  ///< short jobs in a row; reduced whenever the queue has been emptied
};

}  // namespace tunewright::server
