// What came out of computations, on its way into the store. Where the store cannot take it, it is kept here and
// offered again until it does; how much is kept is bounded, because workers claim nothing meanwhile (claims.h).
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "server/jobs/outage.h"
#include "server/jobs/running/held.h"
#include "server/store/store.h"

namespace tunewright::server {

/// A job that has been computed.
struct Ended {
    std::shared_ptr<HeldJob> held;
    JobEnd end;
    double seconds = 0;  ///< of computing
    std::string method;  ///< as in api::JobOutcome; "" where it was not computed
};

class Ends {
public:
    struct Listener {
        /// On the store's thread, once: the store has it, or (`kept` false) it was not this process's any longer.
        std::function<void(const Ended& ended, bool kept)> done;
        std::function<void(const std::shared_ptr<HeldJob>& held)> released;
        /// Bytes of results that wait for the store.
        std::function<void(std::size_t bytes)> unsaved;
    };

    Ends(JobStore& store, Outage& outage, Listener listener);

    void finish(Ended ended);
    /// The job is queued again; where that cannot be written its lease runs out instead.
    void release(const std::shared_ptr<HeldJob>& held);
    /// Offers again what the store could not take.
    void retry();

private:
    void offer(const std::shared_ptr<const Ended>& ended);
    void count(std::size_t more, std::size_t less);

    JobStore& store_;
    Outage& outage_;
    Listener listener_;
    std::mutex mutex_;
    std::vector<std::shared_ptr<const Ended>> refused_;
    std::size_t bytes_ = 0;
};

}  // namespace tunewright::server
