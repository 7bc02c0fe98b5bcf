#include "server/jobs/batch/batches.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "api/json/digest.h"
#include "api/outline.h"
#include "server/jobs/await.h"
#include "server/random.h"

namespace tunewright::server {
namespace {

constexpr std::size_t kMaxGroupEntries = 500;            ///< entries of one write
constexpr std::size_t kMaxGroupBytes = 2 * 1024 * 1024;  ///< bytes of one write, except for a single larger entry
// With a slow client the time between two groups may exceed the store's timeout.
constexpr std::chrono::seconds kReceiptInterval{15};
static_assert(kReceiptInterval * 3 <= JobStore::kReceiving);

/// One batch during its upload, from its bytes into the store. Used by the thread that receives the body; the lane
/// parses it, one piece after the other. Entries are written to the store in groups, with a limited number of bytes in
/// progress: a client that is faster than the store waits.
class Reception {
public:
    Reception(JobStore& store, JobService& jobs, Executor& lane, const std::function<UnixMs()>& now,
              const BatchOrder& order);
    /// Waits for the outstanding answers of the store.
    ~Reception();
    Reception(const Reception&) = delete;
    Reception& operator=(const Reception&) = delete;

    BatchReceipt run(const BatchBody& body);

private:
    using Clock = std::chrono::steady_clock;

    bool take(std::string_view piece);
    void read(std::string_view bytes);
    void take_end();
    void read_end();
    bool find_earlier();
    void keep(std::vector<api::BatchEntry> entries);
    void send();
    void open();
    void sign_of_life();
    BatchReceipt seal();
    void drop();

    void add(std::vector<NewEntry> entries, std::size_t bytes, bool waiting);
    void sent(const Outcome<bool>& outcome, std::size_t bytes, bool waiting);
    bool wait_until(std::size_t bytes_out);
    void fail(BatchReceipt receipt);
    void fail(BatchReceipt::Kind kind) { fail({kind, {}, {}, {}}); }
    bool failed() const;

    JobStore& store_;
    JobService& jobs_;
    Executor& lane_;
    const std::function<UnixMs()>& now_;
    const BatchOrder& order_;
    const std::string id_;

    api::BatchReader reader_;
    api::Sha256 digest_;
    std::vector<NewEntry> group_;
    std::size_t group_bytes_ = 0;
    std::int64_t next_index_ = 0;
    std::optional<bool> earlier_;  ///< true if a batch already has this key
    bool opened_ = false;
    Clock::time_point last_sent_{};

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<BatchReceipt> failure_;  ///< the first failure
    std::size_t out_ = 0;                  ///< calls that the store has not answered yet
    std::size_t bytes_out_ = 0;            ///< of their entries
};

Reception::Reception(JobStore& store, JobService& jobs, Executor& lane, const std::function<UnixMs()>& now,
                     const BatchOrder& order)
    : store_(store), jobs_(jobs), lane_(lane), now_(now), order_(order), id_(new_id()), reader_(order.question) {
    digest_.update(order_.asked);
}

Reception::~Reception() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return out_ == 0; });
}

BatchReceipt Reception::run(const BatchBody& body) {
    const bool whole = body([this](std::string_view piece) { return take(piece); });
    if (!whole && !failed()) fail(BatchReceipt::Kind::abandoned);
    if (whole) take_end();
    if (wait_until(0)) {
        BatchReceipt receipt = seal();
        if (receipt.kind == BatchReceipt::Kind::created || receipt.kind == BatchReceipt::Kind::existing ||
            receipt.kind == BatchReceipt::Kind::conflict)
            return receipt;
        fail(std::move(receipt));
    }
    drop();
    return *failure_;
}

/// Parses a piece of the body on the lane, and waits until the store has kept up.
bool Reception::take(std::string_view piece) {
    if (failed()) return false;
    if (jobs_.draining() || !lane_.run([&] { read(piece); })) return fail(BatchReceipt::Kind::draining), false;
    if (opened_ && Clock::now() - last_sent_ > kReceiptInterval) sign_of_life();
    return wait_until(kMaxGroupBytes);
}

/// Takes the entries that are known only at the end. They come in portions: all of them together, those of a day of
/// many loops, would be 100 MB on their way to the store.
void Reception::take_end() {
    do {
        if (!lane_.run([this] { read_end(); })) return fail(BatchReceipt::Kind::draining);
    } while (reader_.more() && wait_until(kMaxGroupBytes));
}

/// A known key: the body is only compared with that of the earlier batch.
bool Reception::find_earlier() {
    if (order_.idempotency_key.empty() || earlier_) return true;
    try {
        earlier_ = store_.batch_of_key(order_.owner, order_.idempotency_key).has_value();
        return true;
    } catch (const StoreError& error) {
        return fail({BatchReceipt::Kind::store_failed, {}, {}, {error.kind, error.what()}}), false;
    }
}

void Reception::read(std::string_view bytes) {
    if (!find_earlier()) return;
    digest_.update(bytes);
    if (earlier_.value_or(false)) return;
    std::vector<api::BatchEntry> entries;
    auto problem = reader_.feed(bytes, entries);
    if (problem) return fail({BatchReceipt::Kind::refused, {}, *std::move(problem), {}});
    keep(std::move(entries));
}

void Reception::read_end() {
    if (!find_earlier()) return;
    if (earlier_.value_or(false)) return open();
    std::vector<api::BatchEntry> entries;
    auto problem = reader_.finish(entries);
    if (problem) return fail({BatchReceipt::Kind::refused, {}, *std::move(problem), {}});
    keep(std::move(entries));
    if (!reader_.more()) send();
}

void Reception::keep(std::vector<api::BatchEntry> entries) {
    for (api::BatchEntry& entry : entries) {
        NewEntry made;
        made.index = next_index_++;
        made.id = new_id();
        made.name = std::move(entry.name);
        if (auto* job = std::get_if<api::PreparedJob>(&entry.job)) {
            made.timeout_s = job->timeout_s;
            made.request = std::move(job->request_json);
            made.request_hash = std::move(job->request_hash);
        } else {
            made.error = api::to_json(std::get<api::Problem>(entry.job));
            made.outline = api::error_outline(made.error);
        }
        group_bytes_ += made.request.size() + made.error.size();
        group_.push_back(std::move(made));
        if (group_.size() >= kMaxGroupEntries || group_bytes_ >= kMaxGroupBytes) send();
    }
}

void Reception::send() {
    std::vector<NewEntry> group = std::exchange(group_, {});
    const std::size_t bytes = std::exchange(group_bytes_, 0);
    if (group.empty() || failed()) return;
    open();
    const auto waiting = static_cast<std::size_t>(
        std::ranges::count_if(group, [](const NewEntry& entry) { return entry.error.empty(); }));
    if (waiting > 0 && !jobs_.room_for_entries(waiting)) return fail(BatchReceipt::Kind::queue_full);
    add(std::move(group), bytes, waiting > 0);
}

void Reception::open() {
    if (std::exchange(opened_, true)) return;
    {
        const std::lock_guard lock(mutex_);
        ++out_;
    }
    last_sent_ = Clock::now();
    store_.open_batch(
        {id_, reader_.name(), order_.owner, order_.flow, now_(), target_of(reader_.notify()), order_.origin},
        [this](const Outcome<bool>& outcome) { sent(outcome, 0, false); });
}

void Reception::sign_of_life() { add({}, 0, false); }

void Reception::add(std::vector<NewEntry> entries, std::size_t bytes, bool waiting) {
    {
        const std::lock_guard lock(mutex_);
        ++out_;
        bytes_out_ += bytes;
    }
    last_sent_ = Clock::now();
    store_.add_entries(id_, std::move(entries), now_(),
                       [this, bytes, waiting](const Outcome<bool>& outcome) { sent(outcome, bytes, waiting); });
}

/// From any thread. The last access to this object: it may be destroyed as soon as the lock is released.
void Reception::sent(const Outcome<bool>& outcome, std::size_t bytes, bool waiting) {
    if (const auto* fault = std::get_if<StoreFault>(&outcome))
        fail({BatchReceipt::Kind::store_failed, {}, {}, *fault});
    else if (!std::get<bool>(outcome))
        fail(BatchReceipt::Kind::cancelled);
    else if (waiting)
        jobs_.work_arrived();
    const std::lock_guard lock(mutex_);
    --out_;
    bytes_out_ -= bytes;
    changed_.notify_all();
}

/// False if the batch has failed; 0 waits for every call of the store.
bool Reception::wait_until(std::size_t bytes_out) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return failure_ || (bytes_out > 0 ? bytes_out_ <= bytes_out : out_ == 0); });
    return !failure_;
}

BatchReceipt Reception::seal() {
    const auto outcome = await<Outcome<Sealed>>([this](const Done<Sealed>& done) {
        store_.seal_batch({id_, digest_.hex(), order_.idempotency_key, reader_.name(), target_of(reader_.notify())},
                          done);
    });
    if (const auto* fault = std::get_if<StoreFault>(&outcome))
        return {BatchReceipt::Kind::store_failed, {}, {}, *fault};
    const auto& what = std::get<Sealed>(outcome);
    switch (what.kind) {
        case Sealed::Kind::none: return {BatchReceipt::Kind::cancelled, {}, {}, {}};
        case Sealed::Kind::conflict: return {BatchReceipt::Kind::conflict, {}, {}, {}};
        case Sealed::Kind::existing: return {BatchReceipt::Kind::existing, what.id, {}, {}};
        case Sealed::Kind::sealed: break;
    }
    // The earlier batch was deleted while this body was compared with it.
    if (next_index_ == 0) return {BatchReceipt::Kind::store_failed, {}, {}, {}};
    return {BatchReceipt::Kind::created, what.id, {}, {}, reader_.notes()};
}

/// Returns when none of it is stored; a store that cannot drop it now does so later, when the receiver's timeout is
/// over.
void Reception::drop() {
    if (!opened_) return;
    jobs_.batch_dropped(id_);
    await<Outcome<bool>>([this](const Done<bool>& done) { store_.drop_batch(id_, done); });
}

void Reception::fail(BatchReceipt receipt) {
    const std::lock_guard lock(mutex_);
    if (!failure_) failure_ = std::move(receipt);
    changed_.notify_all();
}

bool Reception::failed() const {
    const std::lock_guard lock(mutex_);
    return failure_.has_value();
}

}  // namespace

Batches::Batches(JobStore& store, JobService& jobs, Executor& lane, std::function<UnixMs()> now)
    : store_(store), jobs_(jobs), lane_(lane), now_(std::move(now)) {}

BatchReceipt Batches::receive(BatchOrder order, const BatchBody& body) {
    return Reception(store_, jobs_, lane_, now_, order).run(body);
}

void Batches::cancel(const std::string& id, Done<bool> done) {
    store_.cancel_batch(id, now_(),
                        [this, done = std::move(done)](Outcome<std::optional<std::vector<std::string>>> outcome) {
                            if (const auto* fault = std::get_if<StoreFault>(&outcome)) return done(*fault);
                            const auto& running = std::get<std::optional<std::vector<std::string>>>(outcome);
                            if (running) {
                                jobs_.stop_running(*running);
                                jobs_.look_again();
                            }
                            done(running.has_value());
                        });
}

}  // namespace tunewright::server
