#include "server/jobs/running/workers.h"

#include <algorithm>

#include "api/outline.h"
#include "server/clock.h"
#include "server/jobs/running/result_outbox.h"
#include "server/log.h"
#include "server/threads/executor.h"

namespace tunewright::server {
namespace {

using Status = api::JobOutcome::Status;
using Stop = HeldJob::Stop;

constexpr int kNiceness = 10;

}  // namespace

Workers::Workers(Claims& claims, ResultOutbox& outbox, Timer& timer, WorkerSettings settings)
    : claims_(claims), outbox_(outbox), timer_(timer), settings_(std::move(settings)) {}

void Workers::start() {
    for (std::size_t i = 0; i < settings_.count; i++)
        threads_.emplace_back([this](const std::stop_token& stop) { work(stop); });
}

void Workers::request_stop() {
    for (std::jthread& thread : threads_) thread.request_stop();
}

void Workers::join() { threads_.clear(); }

void Workers::work(const std::stop_token& stop) {
    be_nice(kNiceness);
    while (const std::shared_ptr<HeldJob> held = claims_.take(stop)) run(held);
}

void Workers::run(const std::shared_ptr<HeldJob>& held) {
    held->enter(HeldJob::Stage::computing);
    if (held->why() != Stop::none) return end_unbegun(held);
    if (settings_.begun) settings_.begun(held->job);
    // The time in which the claimed job waited for a worker does not count.
    const Timer::Key deadline =
        timer_.after(std::chrono::duration<double>(held->job.timeout_s), [held] { held->request(Stop::timeout); });
    const double started = monotonic_ms();
    api::JobOutcome outcome = compute(held);
    timer_.cancel(deadline);
    const double seconds = (monotonic_ms() - started) / 1e3;
    claims_.took(seconds, outcome.status != Status::cancelled);
    end(held, std::move(outcome), seconds);
}

api::JobOutcome Workers::compute(const std::shared_ptr<HeldJob>& held) {
    RunControl control;
    control.stop = held->token();
    control.now_ms = monotonic_ms;
    control.progress = [&held](const Progress& progress) { held->report(progress); };
    try {
        return settings_.run({held->job.request, held->job.request_hash}, control);
    } catch (const std::exception& fault) {
        log_error("job " + held->job.id + " failed by an internal error: " + fault.what());
        return {Status::failed, "",
                fault_problem("The computation failed because of an internal error of the service; its log has details "
                              "under the job's id.")};
    }
}

void Workers::end_unbegun(const std::shared_ptr<HeldJob>& held) { end(held, {Status::cancelled, "", ""}, 0); }

void Workers::end(const std::shared_ptr<HeldJob>& held, api::JobOutcome outcome, double seconds) {
    const Stop why = held->why();
    if (why == Stop::lost || why == Stop::dropped) return settings_.lost(held);
    if (outcome.status == Status::cancelled && why == Stop::shutdown) return outbox_.release(held);
    JobEvent event = outcome.status == Status::succeeded ? JobEvent::succeed : JobEvent::fail;
    if (outcome.status == Status::cancelled && why == Stop::cancel) event = JobEvent::cancel;
    if (outcome.status == Status::cancelled && why == Stop::timeout)
        outcome.error_json = timeout_problem(held->job.timeout_s);
    JobEnd end;
    end.seq = held->job.seq;
    end.id = held->job.id;
    end.attempts = held->job.attempts;
    end.status = transition(JobStatus::running, event).value();
    end.result = std::move(outcome.result_json);
    end.error = std::move(outcome.error_json);
    if (end.status == JobStatus::failed && end.error.empty())
        end.error = fault_problem("The computation failed without a reason.");
    end.outline = outcome.outline_json.empty() && !end.error.empty() ? api::error_outline(end.error)
                                                                     : std::move(outcome.outline_json);
    end.first = held->job.batch.empty();
    end.version = settings_.version;
    // The start time is from the database's clock, which this process knows to about a millisecond.
    end.finished_at = std::max(settings_.now(), held->job.started_at.value_or(held->job.created_at));
    outbox_.finish({held, std::move(end), seconds, std::move(outcome.method)});
}

}  // namespace tunewright::server
