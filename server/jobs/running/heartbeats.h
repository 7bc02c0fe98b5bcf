// Signs of life of this process: while the store hears them, its jobs are its own. They carry the progress of what runs
// here, and bring what others want of it: a cancel, or the news that a job is not this process's any longer.
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
    std::chrono::milliseconds poll{500};  ///< others learn of progress, and this process of cancels, that quickly
    bool shared = false;                  ///< others use the store too
    std::function<UnixMs()> now;
    std::function<void(const std::shared_ptr<HeldJob>&)> cancelled;  ///< somebody, perhaps elsewhere, asked for it
    std::function<void(const std::shared_ptr<HeldJob>&)> lost;       ///< another has it, or it is gone
};

class Heartbeats {
public:
    Heartbeats(JobQueue& queue, HeldJobs& held, StoreOutageLog& outage, HeartbeatSettings settings);

    /// How often beat() is to be called.
    std::chrono::milliseconds interval() const;
    /// Nothing while an earlier one is under way, nor where there is nothing to say.
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
    HeldJob::Clock::time_point last_{};                      ///< this and the next of the caller's thread alone
    std::map<std::int64_t, std::pair<int, unsigned>> sent_;  ///< attempt and revision of the progress last sent
};

}  // namespace tunewright::server
