#include "server/jobs/batch/batches.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "api/json/digest.h"

namespace tunewright::server {
namespace {

constexpr std::size_t kGroup = 500;  ///< entries of one write
constexpr std::size_t kFewOut = 3;   ///< groups on their way while more bytes are read
constexpr std::chrono::seconds kLifeSign{15};
static_assert(kLifeSign * 3 <= JobStore::kReceiving);

/// Brings the entries of one batch from its bytes into the store. Bytes are read on the lane, one piece after the
/// other. Entries go to the store in groups; while kFewOut groups are on their way, no more bytes are asked for.
class StoringReceiver : public BatchReceiver, public std::enable_shared_from_this<StoringReceiver> {
public:
    StoringReceiver(JobStore& store, JobService& jobs, Timer& timer, Executor& lane, std::function<UnixMs()> now,
                    BatchOrder order, std::function<void(BatchReceipt)> done);

    void feed(std::string bytes, std::function<void()> more) override;
    void finish() override;
    void abandon() override;

private:
    // On the lane.
    void read(const std::string& bytes, const std::function<void()>& more);
    void read_end();
    bool find_earlier();
    void take(std::vector<api::BatchEntry> entries);
    void send();
    void open();
    bool over();
    void when_few_are_out(std::size_t few, std::function<void()> then);

    // From any thread.
    void sent(const Outcome<bool>& outcome, bool waiting);
    void seal();
    void sealed(const Outcome<Sealed>& outcome);
    void sign_of_life();
    void end(BatchReceipt receipt);
    void fail(BatchReceipt::Kind kind);

    JobStore& store_;
    JobService& jobs_;
    Timer& timer_;
    Executor& lane_;
    const std::function<UnixMs()> now_;
    const BatchOrder order_;
    const std::string id_;

    // Of the lane: one task of this batch at a time.
    api::BatchReader reader_;
    api::Sha256 digest_;
    std::vector<NewEntry> group_;
    std::int64_t next_index_ = 0;
    std::optional<bool> earlier_;  ///< whether a batch has this key already

    std::mutex mutex_;
    std::function<void(BatchReceipt)> done_;  ///< empty after it was called
    bool opened_ = false;
    std::size_t out_ = 0;  ///< groups that the store has not reported
    std::size_t few_ = 0;
    std::function<void()> then_;  ///< as soon as no more than `few_` are out
};

StoringReceiver::StoringReceiver(JobStore& store, JobService& jobs, Timer& timer, Executor& lane,
                                 std::function<UnixMs()> now, BatchOrder order, std::function<void(BatchReceipt)> done)
    : store_(store),
      jobs_(jobs),
      timer_(timer),
      lane_(lane),
      now_(std::move(now)),
      order_(std::move(order)),
      id_(new_job_id()),
      reader_(order_.question),
      done_(std::move(done)) {
    digest_.update(order_.asked);
}

void StoringReceiver::feed(std::string bytes, std::function<void()> more) {
    lane_.post(
        [self = shared_from_this(), bytes = std::move(bytes), more = std::move(more)] { self->read(bytes, more); });
}

void StoringReceiver::finish() {
    lane_.post([self = shared_from_this()] { self->read_end(); });
}

void StoringReceiver::abandon() { fail(BatchReceipt::Kind::abandoned); }

// A known key: the body is only compared with the earlier one's.
bool StoringReceiver::find_earlier() {
    if (order_.idempotency_key.empty() || earlier_) return true;
    try {
        earlier_ = store_.batch_of_key(order_.owner, order_.idempotency_key).has_value();
        return true;
    } catch (const StoreError& error) {
        end({BatchReceipt::Kind::store_failed, {}, {}, {error.kind, error.what()}});
        return false;
    }
}

void StoringReceiver::read(const std::string& bytes, const std::function<void()>& more) {
    if (over()) return;
    if (jobs_.draining()) return fail(BatchReceipt::Kind::draining);
    if (!find_earlier()) return;
    digest_.update(bytes);
    if (earlier_.value_or(false)) return more();
    std::vector<api::BatchEntry> entries;
    auto problem = reader_.feed(bytes, entries);
    if (problem) return end({BatchReceipt::Kind::refused, {}, *std::move(problem), {}});
    take(std::move(entries));
    when_few_are_out(kFewOut, more);
}

void StoringReceiver::read_end() {
    if (!find_earlier()) return;
    if (earlier_.value_or(false)) {
        open();
        return when_few_are_out(0, [self = shared_from_this()] { self->seal(); });
    }
    std::vector<api::BatchEntry> entries;
    auto problem = reader_.finish(entries);
    if (problem) return end({BatchReceipt::Kind::refused, {}, *std::move(problem), {}});
    take(std::move(entries));
    send();
    when_few_are_out(0, [self = shared_from_this()] { self->seal(); });
}

void StoringReceiver::take(std::vector<api::BatchEntry> entries) {
    for (api::BatchEntry& entry : entries) {
        NewEntry made;
        made.index = next_index_++;
        made.id = new_job_id();
        made.name = std::move(entry.name);
        if (auto* job = std::get_if<api::PreparedJob>(&entry.job)) {
            made.timeout_s = job->timeout_s;
            made.request = std::move(job->request_json);
            made.request_hash = std::move(job->request_hash);
        } else {
            made.error = api::to_json(std::get<api::Problem>(entry.job));
        }
        group_.push_back(std::move(made));
        if (group_.size() >= kGroup) send();
    }
}

void StoringReceiver::send() {
    std::vector<NewEntry> group = std::exchange(group_, {});
    if (group.empty() || over()) return;
    open();
    const auto waiting = static_cast<std::size_t>(
        std::ranges::count_if(group, [](const NewEntry& entry) { return entry.error.empty(); }));
    if (waiting > 0 && !jobs_.room_for_entries(waiting)) return fail(BatchReceipt::Kind::queue_full);
    {
        const std::lock_guard lock(mutex_);
        if (!done_) return;
        ++out_;
    }
    store_.add_entries(
        id_, std::move(group), now_(),
        [self = shared_from_this(), waiting](const Outcome<bool>& outcome) { self->sent(outcome, waiting > 0); });
}

bool StoringReceiver::over() {
    const std::lock_guard lock(mutex_);
    return !done_;
}

void StoringReceiver::open() {
    {
        const std::lock_guard lock(mutex_);
        if (!done_ || std::exchange(opened_, true)) return;
        ++out_;
    }
    store_.open_batch({id_, reader_.name(), order_.owner, order_.flow, now_()},
                      [self = shared_from_this()](const Outcome<bool>& outcome) { self->sent(outcome, false); });
    sign_of_life();
}

void StoringReceiver::when_few_are_out(std::size_t few, std::function<void()> then) {
    {
        const std::lock_guard lock(mutex_);
        if (!done_) return;
        if (out_ > few) {
            few_ = few;
            then_ = std::move(then);
            return;
        }
    }
    then();
}

void StoringReceiver::sent(const Outcome<bool>& outcome, bool waiting) {
    if (const auto* fault = std::get_if<StoreFault>(&outcome))
        return end({BatchReceipt::Kind::store_failed, {}, {}, *fault});
    if (!std::get<bool>(outcome)) return fail(BatchReceipt::Kind::cancelled);
    if (waiting) jobs_.work_arrived();
    std::function<void()> then;
    {
        const std::lock_guard lock(mutex_);
        --out_;
        if (done_ && out_ <= few_) then = std::exchange(then_, {});
    }
    if (then) then();
}

void StoringReceiver::seal() {
    lane_.post([self = shared_from_this()] {
        self->store_.seal_batch({self->id_, self->digest_.hex(), self->order_.idempotency_key, self->reader_.name()},
                                [self](const Outcome<Sealed>& outcome) { self->sealed(outcome); });
    });
}

void StoringReceiver::sealed(const Outcome<Sealed>& outcome) {
    if (const auto* fault = std::get_if<StoreFault>(&outcome))
        return end({BatchReceipt::Kind::store_failed, {}, {}, *fault});
    const auto& what = std::get<Sealed>(outcome);
    switch (what.kind) {
        case Sealed::Kind::none: return fail(BatchReceipt::Kind::cancelled);
        case Sealed::Kind::conflict: return end({BatchReceipt::Kind::conflict, {}, {}, {}});
        case Sealed::Kind::existing: return end({BatchReceipt::Kind::existing, what.id, {}, {}});
        case Sealed::Kind::sealed: break;
    }
    // The earlier one was deleted while this body was compared with it.
    if (next_index_ == 0) return end({BatchReceipt::Kind::store_failed, {}, {}, {}});
    end({BatchReceipt::Kind::created, what.id, {}, {}});
}

// A slow client may leave more time between two groups than the store waits.
void StoringReceiver::sign_of_life() {
    timer_.after(kLifeSign, [weak = weak_from_this()] {
        const auto self = weak.lock();
        if (!self) return;
        {
            const std::lock_guard lock(self->mutex_);
            if (!self->done_) return;
            ++self->out_;
        }
        self->store_.add_entries(self->id_, {}, self->now_(),
                                 [self](const Outcome<bool>& outcome) { self->sent(outcome, false); });
        self->sign_of_life();
    });
}

void StoringReceiver::fail(BatchReceipt::Kind kind) { end({kind, {}, {}, {}}); }

void StoringReceiver::end(BatchReceipt receipt) {
    std::function<void(BatchReceipt)> done;
    std::function<void()> then;
    bool drop = false;
    {
        const std::lock_guard lock(mutex_);
        if (!done_) return;
        done = std::exchange(done_, {});
        then = std::exchange(then_, {});
        drop = opened_ && receipt.kind != BatchReceipt::Kind::created && receipt.kind != BatchReceipt::Kind::existing &&
               receipt.kind != BatchReceipt::Kind::conflict;
    }
    if (!drop) return done(std::move(receipt));
    // Told when nothing of it is kept; a store that cannot drop it now does so later, for it hears of it no more.
    store_.drop_batch(id_, [done, receipt](const Outcome<bool>&) { done(receipt); });
}

}  // namespace

Batches::Batches(JobStore& store, JobService& jobs, Timer& timer, Executor& lane, std::function<UnixMs()> now)
    : store_(store), jobs_(jobs), timer_(timer), lane_(lane), now_(std::move(now)) {}

std::shared_ptr<BatchReceiver> Batches::receive(BatchOrder order, std::function<void(BatchReceipt)> done) {
    return std::make_shared<StoringReceiver>(store_, jobs_, timer_, lane_, now_, std::move(order), std::move(done));
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
