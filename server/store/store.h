// Where jobs live: a queue, an archive, batches and what is to be delivered, in one place, so that a job moves from one
// to the other in one transaction. One suite of tests (tests/server/store/store_conformance.h) holds each store to its
// interfaces; whoever needs one of them takes that one.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

#include "server/store/archive.h"
#include "server/store/batches.h"
#include "server/store/deliveries.h"
#include "server/store/queue.h"

namespace tunewright::server {

/// What other processes on the same store have done. A hint: it may be lost, the tables are the truth.
struct StoreNotice {
    enum class Kind { queued, progress, ended, cancel };
    Kind kind = Kind::queued;
    std::string id;  ///< of the job; "" for queued, and for ended where many have (a batch was cancelled)
};

class JobStore : public JobQueue, public JobArchive, public BatchStore, public DeliveryStore {
public:
    /// True where other processes may use the same store at the same time.
    virtual bool shared() const = 0;
    /// `listener` runs on a thread of the store's. In a store for one process it never does.
    virtual void watch(std::function<void(const StoreNotice&)> listener) = 0;
    /// False after a write failed or the connection was lost, true again after one succeeded.
    virtual bool healthy() const = 0;
    /// How far the store's own clock is ahead of this process's; 0 where it has none. All times that processes write
    /// are the store's, so that the clocks of machines need not agree.
    virtual std::chrono::milliseconds clock_ahead() const { return std::chrono::milliseconds(0); }
};

}  // namespace tunewright::server
