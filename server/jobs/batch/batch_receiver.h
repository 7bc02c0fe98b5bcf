// Entries of one batch, from its bytes into the store.
#pragma once

#include <mutex>

#include "api/json/digest.h"
#include "server/jobs/batch/batches.h"

namespace tunewright::server {

/// Bytes are read on the lane, one piece after the other; entries go to the store in groups, a few of which may be on
/// their way at a time: then no more bytes are asked for.
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

}  // namespace tunewright::server
