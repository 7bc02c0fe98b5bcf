// Batches: many jobs posted at once, stored piece by piece, and read, cancelled and deleted as one.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "server/clock.h"
#include "server/store/archive.h"
#include "server/store/fault.h"
#include "server/store/queue.h"

namespace tunewright::server {

struct NewBatch {
    std::string id;
    std::string name;
    std::string owner;
    std::string flow;
    UnixMs created_at = 0;
    NotifyTarget notify = {};
    JobOrigin origin = {};
};

struct NewEntry {
    std::int64_t index = 0;  ///< from 0 without gaps, ascending over the calls
    std::string id;
    std::string name;
    double timeout_s = 60;
    std::string request;  ///< "" if it could not be read
    std::string request_hash;
    std::string error;         ///< problem of an entry that fails from the start; "" for one that waits
    std::string outline = {};  ///< of an entry that fails from the start
};

struct BatchSummary {
    std::int64_t seq = 0;
    std::string id;
    std::string name;
    std::string owner;
    UnixMs created_at = 0;
    bool sealed = false;  ///< all its entries have arrived
    bool cancel_requested = false;
    std::size_t total = 0;
    std::size_t queued = 0, running = 0, succeeded = 0, failed = 0, cancelled = 0;
    std::optional<UnixMs> finished_at;  ///< of its last job, once all have ended and it is sealed
    std::string traceparent;            ///< of the call that posted it; "" if it had none

    bool ended() const { return sealed && queued == 0 && running == 0; }
};

struct BatchPage {
    std::vector<BatchSummary> batches;  ///< newest first
    bool more = false;
};

struct BatchRow {
    std::int64_t index = 0;
    std::string id;
    std::string name;
    JobStatus status = JobStatus::queued;
    std::string result;
    std::string error;
};

/// The end of a batch's upload.
struct BatchSeal {
    std::string batch;
    std::string request_hash;
    std::string idempotency_key;  ///< "" if none; keys belong to an owner
    std::string name;             ///< set if it became known after the batch was opened; "" leaves the name
    NotifyTarget notify = {};     ///< set if it became known after the batch was opened
};

struct Sealed {
    enum class Kind { none, sealed, existing, conflict };  ///< existing, conflict: this batch has been dropped
    Kind kind = Kind::none;
    std::string id;  ///< of sealed and existing
};

class BatchStore {
public:
    virtual ~BatchStore() = default;

    /// Entries may run as soon as they are added. Until it is sealed, the receiver of a batch must call add_entries,
    /// possibly without entries, at least every `kReceiving`; otherwise reclaim() drops it like drop_batch().
    static constexpr std::chrono::milliseconds kReceiving{60'000};
    virtual void open_batch(NewBatch batch, Done<bool> done) = 0;
    /// False if the batch does not exist, is sealed or cancelled.
    virtual void add_entries(std::string batch, std::vector<NewEntry> entries, UnixMs now, Done<bool> done) = 0;
    /// With a known key ("" if none): the earlier batch, or a conflict if its hash differs; this one is dropped.
    virtual void seal_batch(BatchSeal seal, Done<Sealed> done) = 0;
    /// Deletes the batch and its jobs, whatever their state; a worker that has one learns it from beat().
    virtual void drop_batch(std::string batch, Done<bool> done) = 0;
    virtual std::optional<BatchSummary> find_batch(const std::string& id) = 0;
    virtual std::optional<std::string> batch_of_key(const std::string& owner, const std::string& idempotency_key) = 0;
    virtual BatchPage list_batches(const std::optional<std::string>& owner, int limit,
                                   std::optional<std::int64_t> before_seq) = 0;
    /// At most `limit` rows with index >= from, in order. Fewer after `kRowsBytes`; at least one, if there is one.
    static constexpr std::size_t kRowsBytes = 1024 * 1024;
    virtual std::vector<BatchRow> batch_rows(const std::string& id, std::int64_t from, std::size_t limit) = 0;
    /// Cancels waiting jobs and asks running ones to stop: their ids. Empty if there is no such batch.
    virtual void cancel_batch(std::string id, UnixMs now, Done<std::optional<std::vector<std::string>>> done) = 0;
    /// Deletes only a batch whose jobs have all ended.
    virtual void remove_batch(std::string id, Done<RemoveEffect> done) = 0;
};

}  // namespace tunewright::server
