#include "server/jobs/batch/batches.h"

#include "server/jobs/batch/batch_receiver.h"

namespace tunewright::server {

Batches::Batches(JobStore& store, JobService& jobs, Timer& timer, Executor& lane, std::function<UnixMs()> now)
    : store_(store), jobs_(jobs), timer_(timer), lane_(lane), now_(std::move(now)) {}

std::shared_ptr<BatchReceiver> Batches::receive(BatchOrder order, std::function<void(BatchReceipt)> done) {
    return std::make_shared<StoringReceiver>(store_, jobs_, timer_, lane_, now_, std::move(order), std::move(done));
}

void Batches::cancel(const std::string& id, Done<bool> done) {
    store_.cancel_batch(id, now_(), [this, done](Outcome<std::optional<std::vector<std::string>>> outcome) {
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
