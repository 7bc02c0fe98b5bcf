// Many jobs posted at once: their way into the store while they arrive, and what is asked of them together.
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
    std::string asked;  ///< what else distinguishes two bodies, such as the parameters of the call
    std::string idempotency_key;
    std::string owner;  ///< as in NewBatch
    std::string flow;
    JobOrigin origin;
};

struct BatchReceipt {
    enum class Kind {
        created,
        existing,    ///< the same body came before under this key
        conflict,    ///< another body came before under this key
        refused,     ///< `problem` says why
        queue_full,  ///< of entries
        draining,
        cancelled,     ///< by somebody, while it was being received
        abandoned,     ///< by its client
        store_failed,  ///< `fault` says why
    };
    Kind kind = Kind::store_failed;
    std::string id;  ///< of created and existing
    api::Problem problem;
    StoreFault fault;
};

/// Gives a body piece after piece to whom it is passed, until that returns false; false where it does not come to its
/// end.
using BatchBody = std::function<bool(const std::function<bool(std::string_view)>&)>;

class Batches {
public:
    /// All must outlive it. What takes long runs on `lane`.
    Batches(JobStore& store, JobService& jobs, Executor& lane, std::function<UnixMs()> now);

    /// Reads the body and puts its entries into the store as they come; returns when the whole batch is durable, or as
    /// soon as it is refused. Entries may run while others are still coming; a batch that does not come to its end
    /// leaves nothing behind.
    BatchReceipt receive(BatchOrder order, const BatchBody& body);

    /// Reads throw StoreError.
    std::optional<BatchSummary> find(const std::string& id) { return store_.find_batch(id); }
    BatchPage list(const std::optional<std::string>& owner, int limit, std::optional<std::int64_t> before_seq) {
        return store_.list_batches(owner, limit, before_seq);
    }
    std::vector<BatchRow> rows(const std::string& id, std::int64_t from, std::size_t limit) {
        return store_.batch_rows(id, from, limit);
    }
    /// Waiting jobs are cancelled, running ones stop soon after. False where there is no such batch.
    void cancel(const std::string& id, Done<bool> done);
    void remove(const std::string& id, Done<RemoveEffect> done) { store_.remove_batch(id, std::move(done)); }

private:
    JobStore& store_;
    JobService& jobs_;
    Executor& lane_;
    std::function<UnixMs()> now_;
};

}  // namespace tunewright::server
