// What came out of computations, on its way into the store. Where the store cannot take it, it is kept here and
// offered again until it does; how much is kept is bounded, because workers claim nothing meanwhile (claims.h). The
// reasons for which a job fails without a result stand here, too.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "server/jobs/running/held.h"
#include "server/jobs/store_outage_log.h"
#include "server/store/queue.h"

namespace tunewright::server {

/// A job that has been computed.
struct Ended {
    std::shared_ptr<HeldJob> held;
    JobEnd end;
    double seconds = 0;  ///< of computing
    std::string method;  ///< as in api::JobOutcome; "" where it was not computed
};

class ResultOutbox {
public:
    struct Listener {
        /// On the store's thread, once: the store has it, or (`kept` false) it was not this process's any longer.
        std::function<void(const Ended& ended, bool kept)> done;
        std::function<void(const std::shared_ptr<HeldJob>& held)> released;
        /// Bytes of results that wait for the store.
        std::function<void(std::size_t bytes)> unsaved;
    };

    ResultOutbox(JobQueue& queue, StoreOutageLog& outage, Listener listener);

    void finish(Ended ended);
    /// The job is queued again; where that cannot be written its lease runs out instead.
    void release(const std::shared_ptr<HeldJob>& held);
    /// Offers again what the store could not take.
    void retry();

private:
    void offer(const std::shared_ptr<const Ended>& ended);
    void count(std::size_t more, std::size_t less);

    JobQueue& queue_;
    StoreOutageLog& outage_;
    Listener listener_;
    std::mutex mutex_;
    std::vector<std::shared_ptr<const Ended>> refused_;
    std::size_t bytes_ = 0;
};

// Problem objects as JSON, ready for the store.
/// The job's time, `timeout_s` seconds, was over.
std::string timeout_problem(double timeout_s);
/// The process that computed it died or was stopped `attempts` times.
std::string given_up_problem(int attempts);
/// A fault of the service itself. `detail` is for the client and shows nothing of the program's inside.
std::string fault_problem(const std::string& detail);

}  // namespace tunewright::server
