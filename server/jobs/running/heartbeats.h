// Heartbeats of this process: while the store receives them, the process keeps its jobs. They carry the progress of the
// jobs that run here, and return requests of other processes: a cancellation, or the notice that this process has lost
// a job.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "server/jobs/running/held.h"
#include "server/jobs/store_outage_log.h"
#include "server/store/queue.h"

namespace tunewright::server {

struct HeartbeatSettings {
    std::string worker;  ///< names this process
    std::chrono::milliseconds lease{10'000};
    std::chrono::milliseconds poll{500};  ///< delay with which others learn of progress, and this process of
                                          ///< cancellations
    bool shared = false;                  ///< other processes use the store too
    std::function<UnixMs()> now;
    std::function<void(const std::shared_ptr<HeldJob>&)> cancelled;  ///< a cancellation was requested, perhaps
                                                                     ///< elsewhere
    std::function<void(const std::shared_ptr<HeldJob>&)> lost;       ///< another process has it, or it was deleted
};

class Heartbeats {
public:
    Heartbeats(JobQueue& queue, HeldJobs& held, StoreOutageLog& outage, HeartbeatSettings settings);

    /// The interval at which beat() is to be called.
    std::chrono::milliseconds interval() const;
    /// Does nothing while an earlier one is in progress, or if there is nothing to report.
    void beat();

private:
    using Asked = std::vector<std::shared_ptr<HeldJob>>;
    bool is_due(const Asked& held);
    std::vector<ProgressNote> notes(const Asked& held);
    void heard(const Asked& asked, const std::vector<Holding>& holdings);
    void release_strays(const std::vector<Holding>& holdings);

    JobQueue& queue_;
    HeldJobs& held_;
    StoreOutageLog& outage_;
    HeartbeatSettings settings_;
    std::atomic<bool> beating_ = false;
    std::atomic<bool> resend_ = false;
    HeldJob::Clock::time_point last_{};                      ///< this and the next member are used by the caller's
                                                             ///< thread only
    std::map<std::int64_t, std::pair<int, unsigned>> sent_;  ///< attempt and revision of the progress last sent
};

}  // namespace tunewright::server
