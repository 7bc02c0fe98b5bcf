// Brings jobs from the store to the workers of this process. One claim is under way at a time, for as many jobs as
// workers are idle; only where many wait and the latest were short a few more are claimed ahead, so that no worker
// waits for the store between them, and nobody hoards heavy ones.
//
// A job during which processes have ended more than once runs alone: it is claimed when nothing else is held, after a
// while nothing else is claimed before it, and nothing beside it. So it takes no other down with it.
//
// Arrivals are counted: a worker that finds nothing sleeps only if nothing has arrived since the store was asked. In a
// store that others use too the count is raised every second as well: hints may be lost, the tables are the truth.
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
    std::size_t max_held = 64;                        ///< no claim while so many are held, results not stored included
    std::size_t max_unsaved = std::size_t{64} << 20;  ///< nor while results of so many bytes wait for the store
    std::function<void(const std::vector<JobRecord>&)> claimed;  ///< called on the store's thread
    std::function<void(std::shared_ptr<HeldJob>)> late;          ///< one that came after close(): it is the listener's
};

class Claims {
public:
    /// All of them must outlive the claims.
    Claims(JobQueue& queue, HeldJobs& held, StoreOutageLog& outage, ClaimSettings settings);

    /// The next job, once there is one; nothing after close() or a stop. Jobs come here before any worker has them, so
    /// they may have been asked to stop already.
    std::shared_ptr<HeldJob> take(const std::stop_token& stop);
    /// Something has been queued, perhaps by another process.
    void arrived();
    /// A computation took so long; not `whole`: it was stopped then.
    void took(double seconds, bool whole = true);
    /// So many bytes of results wait for the store.
    void unsaved(std::size_t bytes);
    /// Claims again after a failure.
    void retry();
    /// So many jobs wait that must run alone.
    void suspects(std::size_t waiting);
    /// One that was held is not any more.
    void freed();
    /// Takes jobs back that no worker has begun: those claimed before `before`, or that one. They are the caller's.
    std::vector<std::shared_ptr<HeldJob>> withdraw(HeldJob::Clock::time_point before);
    bool withdraw(const std::shared_ptr<HeldJob>& held);
    /// No more claims; waits up to `patience` for one that is under way. What no worker has begun is the caller's.
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
    bool failed_ = false;  ///< the last claim: the next one waits for retry()
    bool closed_ = false;
    std::uint64_t claims_ = 0;    ///< so far
    bool more_ = false;           ///< the last claim got all that it asked for
    std::uint64_t arrivals_ = 0;  ///< so far
    std::uint64_t seen_ = 0;      ///< when the store was last asked
    std::size_t unsaved_ = 0;
    bool alone_ = false;  ///< what is held now must run alone
    bool asking_for_suspects_ = false;
    std::size_t suspects_ = 0;
    HeldJob::Clock::time_point suspects_since_{};
    HeldJob::Clock::time_point last_take_{};
    double pace_ = 0;
    std::size_t streak_ = 0;  ///< short jobs in a row; counts less each time that the queue has been emptied
};

}  // namespace tunewright::server
