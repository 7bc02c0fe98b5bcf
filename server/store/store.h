// The storage of jobs: queue, archive, batches and deliveries in one place, so that a job moves between them in one
// transaction. One suite of tests (tests/server/store/store_conformance.h) checks the interfaces of each store; a part
// of the program that needs only one of them takes only that one.
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

/// A change by another process on the same store. A hint: it may be lost, the tables are authoritative.
struct StoreNotice {
    enum class Kind { queued, progress, ended, cancel };
    Kind kind = Kind::queued;
    std::string id;  ///< of the job; "" for queued, and for ended if many have (a batch was cancelled)
};

class JobStore : public JobQueue, public JobArchive, public BatchStore, public DeliveryStore {
public:
    /// True if other processes may use the same store at the same time.
    virtual bool shared() const = 0;
    /// `listener` runs on a thread of the store. In a store for one process it is never called.
    virtual void watch(std::function<void(const StoreNotice&)> listener) = 0;
    /// False after a write failed or the connection was lost, true again after one succeeded.
    virtual bool healthy() const = 0;
    /// Offset of the store's own clock to this process's; 0 if it has none. All times that processes write are the
    /// store's, so that the clocks of machines need not agree.
    virtual std::chrono::milliseconds clock_ahead() const { return std::chrono::milliseconds(0); }
};

}  // namespace tunewright::server
