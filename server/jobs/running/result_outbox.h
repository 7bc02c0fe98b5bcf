// Results on their way into the store. While the store cannot accept them, they are kept here and offered again; the
// amount is bounded, because workers claim nothing meanwhile (claims.h). The problems of jobs that fail without a
// result are defined here, too.
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
    double seconds = 0;  ///< duration of the computation
    std::string method;  ///< as in api::JobOutcome; "" if it was not computed
};

class ResultOutbox {
public:
    struct Listener {
        /// Called once, on the store's thread: the result is stored, or (`kept` false) this process had lost the job.
        std::function<void(const Ended& ended, bool kept)> done;
        std::function<void(const std::shared_ptr<HeldJob>& held)> released;
        /// Bytes of results that wait for the store.
        std::function<void(std::size_t bytes)> unsaved;
    };

    ResultOutbox(JobQueue& queue, StoreOutageLog& outage, Listener listener);

    void finish(Ended ended);
    /// The job is queued again; if that cannot be written, its lease expires instead.
    void release(const std::shared_ptr<HeldJob>& held);
    /// Offers the results again that the store could not accept.
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

// Problem objects as JSON, ready for the store. This one: the time limit of `timeout_s` seconds is over.
std::string timeout_problem(double timeout_s);
/// The process that computed it died or was stopped `attempts` times.
std::string given_up_problem(int attempts);
/// An internal error of the service. `detail` is for the client and reveals nothing about the program.
std::string fault_problem(const std::string& detail);

}  // namespace tunewright::server
