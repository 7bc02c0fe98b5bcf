#include "server/jobs/service.h"

#include <sys/random.h>

#include <array>
#include <future>

#include "server/executor.h"
#include "server/log.h"

namespace tunewright::server {
namespace {

constexpr int kWorkerNiceness = 5;
constexpr std::chrono::seconds kStopPatience{2};
constexpr std::chrono::seconds kRetryPause{1};

double monotonic_ms() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string timeout_error(double timeout_s) {
    Error error;
    error.kind = ErrorKind::timeout;
    error.where = "timeout_s";
    error.message = "The job was stopped after timeout_s = " + std::to_string(timeout_s).substr(0, 6) +
                    " s. Ask for fewer methods or a simpler search, or raise timeout_s.";
    return api::to_json(api::to_problem(error));
}

std::string fault_error(const std::string& detail) {
    api::Problem problem;
    problem.status = 500;
    problem.type = "internal";
    problem.title = "Internal Server Error";
    problem.detail = detail;
    return api::to_json(problem);
}

}  // namespace

std::string new_job_id() {
    constexpr std::string_view alphabet = "0123456789abcdefghjkmnpqrstvwxyz";
    std::array<unsigned char, 26> bytes{};
    if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
        throw std::runtime_error("the system gives no random bytes");
    std::string id;
    for (const unsigned char byte : bytes) id.push_back(alphabet[byte % alphabet.size()]);
    return id;
}

void JobService::Running::request(StopReason why_now) {
    {
        const std::lock_guard lock(mutex);
        if (reason == StopReason::none) reason = why_now;
    }
    stop.request_stop();
}

JobService::StopReason JobService::Running::why() {
    const std::lock_guard lock(mutex);
    return reason;
}

JobService::JobService(JobStore& store, Timer& timer, JobSettings settings)
    : store_(store), timer_(timer), settings_(std::move(settings)) {}

JobService::~JobService() { drain(std::chrono::seconds(0)); }

Recovery JobService::start() {
    const Recovery recovery = store_.recover(
        settings_.now(), settings_.most_attempts,
        fault_error("The job was interrupted " + std::to_string(settings_.most_attempts) +
                    " times by an end of the service and is not tried again. Post it anew if it is not the cause."));
    depth_ = recovery.queued;
    tokens_ = recovery.queued;
    for (std::size_t i = 0; i < settings_.workers; i++)
        threads_.emplace_back([this](const std::stop_token& stop) { work(stop); });
    return recovery;
}

// ---- accepting -------------------------------------------------------------------------------------------------

void JobService::submit(api::PreparedJob job, std::string idempotency_key, std::chrono::duration<double> wait,
                        std::function<void(Submission)> done, std::function<void()> ended) {
    if (draining_) return done({Submission::Kind::draining, {}, {}});
    if (depth_.fetch_add(1) >= settings_.queue_limit) {
        depth_--;
        return done({Submission::Kind::queue_full, {}, {}});
    }
    NewJob entry;
    entry.id = new_job_id();
    entry.name = std::move(job.name);
    entry.timeout_s = job.timeout_s;
    entry.request_hash = std::move(job.request_hash);
    entry.idempotency_key = std::move(idempotency_key);
    entry.created_at = settings_.now();
    auto request = std::make_shared<std::string>(job.request_json);
    entry.request = std::move(job.request_json);

    const auto accepted = [this, request, wait, done = std::move(done),
                           ended = std::move(ended)](Outcome<Accepted> outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) {
            depth_--;
            return done({Submission::Kind::store_failed, {}, *fault});
        }
        auto& value = std::get<Accepted>(outcome);
        Submission submission;
        static_cast<JobSummary&>(submission.job) = std::move(value.job);
        if (value.kind != Accepted::Kind::created) {
            depth_--;
            const bool same = value.kind == Accepted::Kind::existing;
            submission.kind = same ? Submission::Kind::existing : Submission::Kind::conflict;
            return done(std::move(submission));
        }
        submission.kind = Submission::Kind::created;
        submission.job.request = std::move(*request);
        // Before a worker can know of the job, so that its end is not missed.
        if (wait.count() > 0) add_waiter(submission.job.id, wait, ended);
        done(std::move(submission));
        add_token();
    };
    store_.accept(std::move(entry), accepted);
}

std::optional<JobView> JobService::find(const std::string& id) {
    std::shared_ptr<Running> running;
    {
        const std::lock_guard lock(running_mutex_);
        const auto found = running_.find(id);
        if (found != running_.end()) running = found->second;
    }
    std::optional<JobRecord> job = store_.find(id);
    if (!job) return std::nullopt;
    JobView view{*std::move(job), std::nullopt};
    if (running && view.job.status == JobStatus::running) {
        const std::lock_guard lock(running->mutex);
        view.progress = running->progress;
    }
    return view;
}

void JobService::cancel(const std::string& id, Done<CancelEffect> done) {
    store_.cancel(id, settings_.now(), [this, id, done = std::move(done)](Outcome<CancelEffect> outcome) {
        const auto* effect = std::get_if<CancelEffect>(&outcome);
        if (effect != nullptr && *effect == CancelEffect::cancelled) {
            depth_--;
            tell_waiters(id);
        }
        if (effect != nullptr && *effect == CancelEffect::requested) {
            const std::lock_guard lock(running_mutex_);
            const auto found = running_.find(id);
            if (found != running_.end()) found->second->request(StopReason::cancel);
        }
        done(std::move(outcome));
    });
}

// ---- waiting ---------------------------------------------------------------------------------------------------

void JobService::add_waiter(const std::string& id, std::chrono::duration<double> wait, std::function<void()> ended) {
    auto waiter = std::make_shared<Waiter>();
    waiter->ended = std::move(ended);
    const std::lock_guard lock(waiters_mutex_);
    waiter->timeout = timer_.after(wait, [this, id, waiter] {
        {
            const std::lock_guard inner(waiters_mutex_);
            const auto [first, last] = waiters_.equal_range(id);
            const auto found = std::find_if(first, last, [&](const auto& item) { return item.second == waiter; });
            if (found == last) return;
            waiters_.erase(found);
        }
        waiter->ended();
    });
    waiters_.emplace(id, waiter);
}

void JobService::tell_waiters(const std::string& id) {
    std::vector<std::shared_ptr<Waiter>> told;
    {
        const std::lock_guard lock(waiters_mutex_);
        const auto [first, last] = waiters_.equal_range(id);
        for (auto it = first; it != last; ++it) told.push_back(it->second);
        waiters_.erase(first, last);
    }
    for (const auto& waiter : told) {
        timer_.cancel(waiter->timeout);
        waiter->ended();
    }
}

void JobService::tell_all_waiters() {
    std::multimap<std::string, std::shared_ptr<Waiter>> told;
    {
        const std::lock_guard lock(waiters_mutex_);
        told.swap(waiters_);
    }
    for (const auto& [id, waiter] : told) {
        timer_.cancel(waiter->timeout);
        waiter->ended();
    }
}

void JobService::wait(const std::string& id, std::chrono::duration<double> wait, std::function<void()> ended) {
    add_waiter(id, wait, std::move(ended));
    // It may have ended before the waiter was there.
    const std::optional<JobRecord> job = store_.find(id);
    if (!job || has_ended(job->status) || draining_) tell_waiters(id);
}

// ---- working ---------------------------------------------------------------------------------------------------

void JobService::add_token() {
    {
        const std::lock_guard lock(tokens_mutex_);
        tokens_++;
    }
    tokens_changed_.notify_one();
}

bool JobService::take_token(const std::stop_token& stop) {
    std::unique_lock lock(tokens_mutex_);
    if (!tokens_changed_.wait(lock, stop, [this] { return tokens_ > 0; })) return false;
    tokens_--;
    return !stop.stop_requested();
}

void JobService::work(const std::stop_token& stop) {
    be_nice(kWorkerNiceness);
    while (take_token(stop)) {
        try {
            std::optional<JobRecord> job = claim();
            if (job) run_job(*std::move(job));
        } catch (const StoreError& error) {
            log_error(std::string("a worker cannot claim a job: ") + error.what());
            timer_.after(kRetryPause, [this] { add_token(); });
        }
    }
}

std::optional<JobRecord> JobService::claim() {
    std::promise<Outcome<std::optional<JobRecord>>> claimed;
    store_.claim_next(settings_.now(), [&](Outcome<std::optional<JobRecord>> outcome) {
        // Registered on the store's thread: a cancel that the store sees later finds the job here.
        const auto* job = std::get_if<std::optional<JobRecord>>(&outcome);
        if (job != nullptr && *job) {
            depth_--;
            const std::lock_guard lock(running_mutex_);
            running_.emplace((*job)->id, std::make_shared<Running>());
        }
        claimed.set_value(std::move(outcome));
    });
    Outcome<std::optional<JobRecord>> outcome = claimed.get_future().get();
    if (const auto* fault = std::get_if<StoreFault>(&outcome)) throw StoreError(*fault);
    return std::get<std::optional<JobRecord>>(std::move(outcome));
}

api::JobOutcome JobService::compute(const JobRecord& job, Running& running) {
    RunControl control;
    control.stop = running.stop.get_token();
    control.now_ms = monotonic_ms;
    control.progress = [&running](const Progress& progress) {
        const std::lock_guard lock(running.mutex);
        running.progress = progress;
    };
    try {
        return settings_.run(job.request, control);
    } catch (const std::exception& fault) {
        log_error("job " + job.id + " met a fault: " + fault.what());
        return {api::JobOutcome::Status::failed, "",
                fault_error("The computation met a fault of the service; its log says more under the job's id.")};
    }
}

void JobService::run_job(JobRecord job) {
    std::shared_ptr<Running> running;
    {
        const std::lock_guard lock(running_mutex_);
        running = running_.at(job.id);
    }
    const Timer::Key deadline = timer_.after(std::chrono::duration<double>(job.timeout_s),
                                             [running] { running->request(StopReason::timeout); });
    const double started = monotonic_ms();
    api::JobOutcome outcome = compute(job, *running);
    timer_.cancel(deadline);

    using Status = api::JobOutcome::Status;
    auto ended = std::make_shared<JobRecord>(std::move(job));
    ended->result = std::move(outcome.result_json);
    ended->error = std::move(outcome.error_json);
    JobEvent event = JobEvent::fail;
    if (outcome.status == Status::succeeded) event = JobEvent::succeed;
    if (outcome.status == Status::cancelled) {
        const StopReason why = running->why();
        if (why == StopReason::shutdown) return put_back(ended->id);
        event = why == StopReason::timeout ? JobEvent::fail : JobEvent::cancel;
        if (why == StopReason::timeout) ended->error = timeout_error(ended->timeout_s);
    }
    ended->status = transition(JobStatus::running, event).value();
    if (ended->status == JobStatus::failed && ended->error.empty())
        ended->error = fault_error("The computation failed without saying why.");
    ended->finished_at = settings_.now();
    end_job(ended, (monotonic_ms() - started) / 1e3);
}

void JobService::end_job(const std::shared_ptr<JobRecord>& job, double seconds) {
    JobEnd end{job->id, job->status, job->result, job->error, settings_.version, *job->finished_at};
    store_.finish(std::move(end), [this, job, seconds](const Outcome<bool>& outcome) {
        if (std::holds_alternative<StoreFault>(outcome)) {
            // The result is kept in memory and offered again until the disk takes it.
            timer_.after(kRetryPause, [this, job, seconds] { end_job(job, seconds); });
            return;
        }
        if (std::get<bool>(outcome) && settings_.observer.ended) settings_.observer.ended(*job, seconds);
        forget_running(job->id);
        tell_waiters(job->id);
    });
}

void JobService::put_back(const std::string& id) {
    store_.release(id, [this, id](const Outcome<bool>&) {
        forget_running(id);
        tell_waiters(id);
    });
}

void JobService::forget_running(const std::string& id) {
    {
        const std::lock_guard lock(running_mutex_);
        running_.erase(id);
    }
    running_changed_.notify_all();
}

std::size_t JobService::running() const {
    const std::lock_guard lock(running_mutex_);
    return running_.size();
}

// ---- stopping --------------------------------------------------------------------------------------------------

bool JobService::drain(std::chrono::duration<double> grace) {
    draining_ = true;
    for (std::jthread& thread : threads_) thread.request_stop();
    bool idle = false;
    {
        std::unique_lock lock(running_mutex_);
        idle = running_changed_.wait_for(lock, grace, [this] { return running_.empty(); });
        if (!idle) {
            for (const auto& [id, running] : running_) running->request(StopReason::shutdown);
            idle = running_changed_.wait_for(lock, kStopPatience, [this] { return running_.empty(); });
        }
    }
    tell_all_waiters();
    if (idle) threads_.clear();
    return idle;
}

}  // namespace tunewright::server
