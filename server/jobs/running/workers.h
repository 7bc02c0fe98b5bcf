// The threads that compute: each takes a job, computes it with a deadline, and passes on the result.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "api/service.h"
#include "server/jobs/running/claims.h"
#include "server/jobs/running/held.h"
#include "server/jobs/running/result_outbox.h"
#include "server/threads/timer.h"

namespace tunewright::server {

struct WorkerSettings {
    std::size_t count = 1;
    std::string version;
    std::function<api::JobOutcome(const api::StoredRequest& request, const RunControl& control)> run;
    std::function<UnixMs()> now;
    std::function<void(const JobRecord& job)> begun;            ///< may be empty
    std::function<void(const std::shared_ptr<HeldJob>&)> lost;  ///< stopped because another process has it
};

class Workers {
public:
    Workers(Claims& claims, ResultOutbox& outbox, Timer& timer, WorkerSettings settings);

    void start();
    /// The workers take no more jobs.
    void request_stop();
    /// Waits until each has ended its job.
    void join();
    /// Ends a job that no worker has begun or will begin.
    void end_unbegun(const std::shared_ptr<HeldJob>& held);

private:
    void work(const std::stop_token& stop);
    void run(const std::shared_ptr<HeldJob>& held);
    api::JobOutcome compute(const std::shared_ptr<HeldJob>& held);
    void end(const std::shared_ptr<HeldJob>& held, api::JobOutcome outcome, double seconds);

    Claims& claims_;
    ResultOutbox& outbox_;
    Timer& timer_;
    WorkerSettings settings_;
    std::vector<std::jthread> threads_;
};

}  // namespace tunewright::server
