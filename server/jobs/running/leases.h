// Signs of life for the jobs that this process holds, and the search for jobs whose process has gone.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "server/jobs/outage.h"
#include "server/jobs/running/held.h"
#include "server/store/store.h"

namespace tunewright::server {

struct LeaseSettings {
    std::chrono::milliseconds lease{10'000};
    std::chrono::milliseconds poll{500};  ///< others learn of progress, and this process of cancels, that quickly
    int most_attempts = 10;
    std::string given_up;  ///< problem of a job that was interrupted that often
    std::function<UnixMs()> now;
    std::function<void(const std::shared_ptr<HeldJob>&)> cancelled;  ///< somebody, perhaps elsewhere, asked for it
    std::function<void(const std::shared_ptr<HeldJob>&)> lost;       ///< another has it, or it is gone
    std::function<void(const Recovery&)> reclaimed;                  ///< something was found
};

class Leases {
public:
    Leases(JobStore& store, HeldJobs& held, Outage& outage, LeaseSettings settings);

    /// How often renew() is to be called.
    std::chrono::milliseconds interval() const;
    /// Renews what is due; the latest progress goes along. Nothing while an earlier renewal is under way.
    void renew();
    /// Not where the wall clock has jumped since the last call: then leases are renewed first.
    void reclaim();

private:
    bool clock_jumped();
    void renew(HeldJob::Clock::time_point young);

    void renewed(const std::vector<std::shared_ptr<HeldJob>>& asked, const std::vector<Renewed>& answers);

    JobStore& store_;
    HeldJobs& held_;
    Outage& outage_;
    LeaseSettings settings_;
    std::atomic<bool> renewing_ = false;
    std::atomic<bool> reclaiming_ = false;
    UnixMs last_wall_ = 0;  ///< these and sent_ of the caller's thread alone
    HeldJob::Clock::time_point last_steady_{};
    std::atomic<bool> resend_ = false;
    std::map<std::string, std::pair<int, unsigned>> sent_;  ///< attempt and revision of the progress last sent
};

}  // namespace tunewright::server
