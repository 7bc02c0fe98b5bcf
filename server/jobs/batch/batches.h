// Many jobs posted at once: their upload into the store, and the operations on a whole batch.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/batch/reader.h"
#include "server/jobs/service.h"
#include "server/store/store.h"
#include "server/threads/executor.h"

namespace tunewright::server {

/// A body that is to become a batch.
struct BatchOrder {
    api::BatchQuestion question;
    std::string asked;  ///< other data that distinguish two bodies, such as the parameters of the call
    std::string idempotency_key;
    std::string owner;  ///< as in NewBatch
    std::string flow;
    JobOrigin origin;
};

struct BatchReceipt {
    enum class Kind {
        created,
        existing,    ///< the same body was posted before with this key
        conflict,    ///< another body was posted before with this key
        refused,     ///< `problem` has the reason
        queue_full,  ///< too many entries wait
        draining,
        cancelled,     ///< by somebody, during the upload
        abandoned,     ///< by its client
        store_failed,  ///< `fault` has the reason
    };
    Kind kind = Kind::store_failed;
    std::string id;  ///< of created and existing
    api::Problem problem;
    StoreFault fault;
    std::vector<std::string> notes = {};  ///< of a created one: findings about its files
};

/// Passes a body piece by piece to a function, until that returns false; false if the body is incomplete.
using BatchBody = std::function<bool(const std::function<bool(std::string_view)>&)>;

class Batches {
public:
    /// All references must outlive it. Long work runs on `lane`.
    Batches(JobStore& store, JobService& jobs, Executor& lane, std::function<UnixMs()> now);

    /// Reads the body and stores its entries as they arrive; returns when the whole batch is durable, or as soon as it
    /// is refused. Entries may run while others are still arriving; an incomplete batch leaves nothing behind.
    BatchReceipt receive(BatchOrder order, const BatchBody& body);

    /// Reads throw StoreError.
    std::optional<BatchSummary> find(const std::string& id) { return store_.find_batch(id); }
    BatchPage list(const std::optional<std::string>& owner, int limit, std::optional<std::int64_t> before_seq) {
        return store_.list_batches(owner, limit, before_seq);
    }
    std::vector<BatchRow> rows(const std::string& id, std::int64_t from, std::size_t limit) {
        return store_.batch_rows(id, from, limit);
    }
    /// Waiting jobs are cancelled, running ones stop soon after. False if there is no such batch.
    void cancel(const std::string& id, Done<bool> done);
    void remove(const std::string& id, Done<RemoveEffect> done) { store_.remove_batch(id, std::move(done)); }

private:
    JobStore& store_;
    JobService& jobs_;
    Executor& lane_;
    std::function<UnixMs()> now_;
};

}  // namespace tunewright::server
