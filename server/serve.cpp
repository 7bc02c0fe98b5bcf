#include "server/serve.h"

#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <iostream>

#include "server/access/gate.h"
#include "server/clock.h"
#include "server/http/app/answer_log.h"
#include "server/http/app/problems.h"
#include "server/http/app/router.h"
#include "server/http/app/static_files.h"
#include "server/http/guard/server.h"
#include "server/jobs/batch/batches.h"
#include "server/jobs/job_log.h"
#include "server/jobs/service.h"
#include "server/log.h"
#include "server/metrics/memory.h"
#include "server/metrics/metrics.h"
#include "server/notify/notifier.h"
#include "server/routes/job_json.h"
#include "server/routes/request_checks.h"
#include "server/routes/routes.h"
#include "server/startup_server.h"
#include "server/store/metered_store.h"
#include "server/store/open_store.h"
#include "server/threads/executor.h"
#include "server/threads/spare_cores.h"

namespace tunewright::server {
namespace {

constexpr std::chrono::seconds kStopPatience{2};  // for computations and for the store, after they were asked to stop
constexpr std::size_t kLargeBody = 1 << 20, kWaitingComputations = 64;
constexpr std::size_t kForOthers = 4;  // computations, for clients that have none while others use all cores
// Concurrent answers with a whole job; each may take a hundred megabytes for a moment.
constexpr std::size_t kReaders = 2, kWaitingReaders = 1024;
// Fewer than the connections for reading (a shared store has four), so that lists alone never delay a single job.
constexpr std::size_t kListers = 2, kSearchers = 1;
// Batches are uploaded and downloaded without delaying other calls.
constexpr std::size_t kBatchThreads = 2;
constexpr int kBatchNiceness = 5;

Retention retention_of(const Config& config) {
    const auto age = [](double seconds) -> std::optional<std::chrono::milliseconds> {
        if (seconds == 0) return std::nullopt;
        return std::chrono::milliseconds(static_cast<std::int64_t>(1e3 * seconds));
    };
    const auto own = [&](double seconds) { return age(seconds < 0 ? config.retention_s : seconds); };
    return {age(config.retention_s), own(config.retention_failed_s), own(config.retention_cancelled_s)};
}

/// Allows as many connections as the system permits this process.
void raise_file_limit() {
    rlimit limit{};
    if (::getrlimit(RLIMIT_NOFILE, &limit) != 0) return;
    limit.rlim_cur = limit.rlim_max;
    ::setrlimit(RLIMIT_NOFILE, &limit);
}

std::size_t connection_limit() {
    constexpr std::size_t own_files = 64;
    rlimit limit{};
    ::getrlimit(RLIMIT_NOFILE, &limit);
    return std::clamp<std::size_t>(limit.rlim_cur, 2 * own_files, http::ServerLimits().connections + own_files) -
           own_files;
}

sigset_t stop_signals() {
    sigset_t set;
    sigemptyset(&set);
    sigaddset(&set, SIGTERM);
    sigaddset(&set, SIGINT);
    return set;
}

/// The parts in the order of their construction; stop() destroys them so that none calls one that is gone.
class Service {
public:
    Service(const Config& config, std::unique_ptr<JobStore> store)
        : config_(config),
          memory_(memory_limit(config.memory)),
          store_(metered(std::move(store), [this](std::string_view operation, double seconds,
                                                  bool done) { metrics_.count_store(operation, seconds, done); })),
          spare_cores_(computations(config)),
          jobs_(*store_, timer_, settings(config)),
          turns_(core_count(), std::max(core_count(), kForOthers), kWaitingComputations),
          readers_(std::max(kReaders, core_count()), kReaders, kWaitingReaders),
          listers_(kListers, 1, kWaitingReaders),
          searchers_(kSearchers, kSearchers, kWaitingReaders),
          places_(places_of(limits())),
          batch_lane_(kBatchThreads, kBatchNiceness),
          batches_(*store_, jobs_, batch_lane_, [this] { return now(); }),
          policy_(config.notify_targets, config.notify_secrets),
          notifier_(*store_, policy_, notifier_settings()),
          page_(config.web.empty() ? default_web_folder() : config.web),
          gate_(gate_settings(config)),
          server_(limits(), application(router_)) {
        add_routes();
        if (config.metrics_listen.empty()) return;
        add_health_routes(metrics_router_, config.max_body, config.retention_s, jobs_, *store_, gate_, memory_,
                          [this] { return metrics_.text(standing()); });
        metrics_server_ = std::make_unique<http::Server>(http::ServerLimits(), application(metrics_router_));
    }

    int listen() {
        if (metrics_server_) open_port(*metrics_server_, config_.metrics_listen);
        return open_port(server_, config_.listen);
    }

    void start() {
        const Recovery recovery = jobs_.start();
        if (jobs_.queued() > 0 || recovery.given_up > 0)
            log_info(std::to_string(jobs_.queued()) + " jobs of an earlier run are waiting, " +
                     std::to_string(recovery.interrupted) + " of them were interrupted; " +
                     std::to_string(recovery.given_up) + " were given up");
        notifier_.start();
        watch_memory();
        serving_ = std::jthread([this] { server_.run(); });
        if (metrics_server_) serving_metrics_ = std::jthread([this] { metrics_server_->run(); });
    }

    /// False if a computation did not stop: the process must end without waiting for it.
    bool stop() {
        closing_.request_stop();
        notifier_.close();
        const bool idle = jobs_.drain(std::chrono::duration<double>(config_.drain_timeout_s));
        server_.stop();
        serving_.join();
        if (metrics_server_) {
            metrics_server_->stop();
            serving_metrics_.join();
        }
        const bool stopped = notifier_.stop(kStopPatience);
        if (!server_.idle_within(kStopPatience) || (metrics_server_ && !metrics_server_->idle_within(kStopPatience)))
            return false;
        batch_lane_.stop();
        timer_.stop();
        if (idle && stopped) store_.reset();
        return idle && stopped;
    }

private:
    static std::size_t workers(const Config& config) { return config.workers == 0 ? core_count() : config.workers; }

    /// Including helpers: at most the number of concurrent jobs, and of cores.
    static std::size_t computations(const Config& config) { return std::min(workers(config), core_count()); }

    JobSettings settings(const Config& config) {
        JobSettings made;
        made.workers = parse_role(config.role) == ProcessRole::api ? 0 : workers(config);
        made.queue_limit = config.queue_limit;
        made.entry_limit = config.entry_limit;
        made.client_jobs = config.client_jobs;
        made.max_attempts = config.max_attempts;
        made.lease = std::chrono::milliseconds(static_cast<std::int64_t>(config.lease_s * 1e3));
        made.retention = retention_of(config);
        made.version = TUNEWRIGHT_VERSION;
        made.run = [this](const api::StoredRequest& request, RunControl control) {
            SpareCores::Computation computation(spare_cores_);
            control.spread = computation.spread();
            return api::run_job(request, control);
        };
        made.now = [this] { return now(); };
        made.observer.ended = [this](const Ended& ended) {
            metrics_.count(ended.end.status, ended.method.empty() ? "none" : ended.method, ended.seconds);
            log_job(ended);
            if (ended.held->job.notifies) notifier_.wake();
        };
        made.observer.dropped = [this] { metrics_.count_dropped(); };
        made.observer.limited = [this] { metrics_.count_limited(); };
        made.observer.begun = [this](const JobRecord& job) {
            metrics_.count_begun(!job.batch.empty(), std::max(0.0, static_cast<double>(now() - ready_at(job)) * 1e-3));
        };
        made.observer.recovered = [this](const Recovery& found) { metrics_.count(found); };
        return made;
    }

    NotifierSettings notifier_settings() {
        NotifierSettings made;
        made.now = [this] { return now(); };
        made.job_text = notification_job_json;
        made.batch_text = [](const BatchSummary& batch) { return batch_json(batch); };
        made.count = [this](DeliveryOutcome outcome) { metrics_.count(outcome); };
        made.version = TUNEWRIGHT_VERSION;
        return made;
    }

    /// The store's clock, which the machines of a shared store have in common.
    UnixMs now() const { return wall_clock() + store_->clock_ahead().count(); }

    Standing standing() const {
        Standing made;
        made.queue = jobs_.depth();
        made.now = now();
        made.running = jobs_.running();
        made.workers = jobs_.workers();
        made.clients = server_.occupancy();
        made.memory_limit = memory_.limit();
        made.event_streams = jobs_.followers();
        made.synchronous_waiting = turns_.waiting();
        made.batch_tasks_waiting = batch_lane_.waiting();
        made.log_lines_dropped = dropped_log_lines();
        return made;
    }

    /// A third of the memory is for clients: requests and answers in progress.
    http::ServerLimits limits() const {
        http::ServerLimits made;
        made.connections = connection_limit();
        made.max_body = config_.max_body;
        made.max_batch_body = config_.max_batch_body;
        made.bodies = made.unsent = memory_.limit() / 6;
        made.behind_proxy = config_.behind_proxy;
        return made;
    }

    void watch_memory() {
        memory_.look();
        timer_.after(std::chrono::seconds(1), [this] { watch_memory(); });
    }

    static GateSettings gate_settings(const Config& config) {
        GateSettings made;
        if (config.auth == "keys") made.keys_file = config.keys;
        made.rate = config.rate_limit;
        made.burst = 2 * config.rate_limit;
        made.own_machine = is_loopback(parse_listen(config.listen).host) && !config.behind_proxy;
        made.sites = {parse_listen(config.listen).host, config.allowed_hosts, config.cors_origins, config.behind_proxy};
        made.behind_proxy = config.behind_proxy;
        return made;
    }

    void add_routes() {
        router_.guard([this](http::Request& request) {
            auto refusal = gate_.admit(request);
            if (!refusal && request.has_body() && memory_.tight())
                refusal =
                    http::problem_response(503, "The service has no free memory at the moment. Try again shortly.");
            return refusal;
        });
        add_health_routes(router_, config_.max_body, config_.retention_s, jobs_, *store_, gate_, memory_,
                          [this] { return metrics_.text(standing()); });
        if (parse_role(config_.role) != ProcessRole::worker) add_public_routes();
        router_.observe([this](const http::Answered& answered) {
            metrics_.count(answered);
            http::log_answer(answered);
        });
    }

    /// The routes that a process with the role worker does not have.
    void add_public_routes() {
        add_job_routes(router_, jobs_, places_, {turns_, readers_, listers_, searchers_}, policy_,
                       {config_.job_timeout_s, config_.max_timeout_s});
        add_event_routes(router_, jobs_, places_);
        add_trace_routes(router_, jobs_, readers_);
        add_code_routes(router_, jobs_, readers_);
        add_report_routes(router_, jobs_, batches_, readers_);
        add_queue_routes(router_, jobs_);
        add_batch_routes(router_, batches_, jobs_, places_, listers_, batch_lane_, policy_,
                         {{config_.job_timeout_s, config_.max_timeout_s}, config_.max_body});
        const Computations computations(turns_, timer_, spare_cores_, closing_.get_token());
        add_synchronous_routes(router_, jobs_, computations);
        add_mcp_routes(router_, jobs_, places_, {turns_, readers_, listers_, searchers_}, computations,
                       {config_.job_timeout_s, config_.max_timeout_s});
        add_description_routes(router_);
        router_.set_fallback([this](const http::Request& request) { return page_.find(request); });
    }

    /// Some threads are always free for short calls; one client may use half of the others.
    static std::array<std::size_t, 2> places_of(const http::ServerLimits& limits) {
        const std::size_t lasting = limits.connections * 3 / 4;
        return {lasting, lasting / 2};
    }

    http::Application application(const http::Router& router) {
        http::Application made;
        made.admit = [&router](http::Request& request) { return router.admit(request); };
        made.streams = [&router](const http::Request& head) { return router.streams(head); };
        made.weight = handling_weight;
        made.handle = [this, &router](http::Request request) {
            const bool large = request.body.size() > kLargeBody;
            http::Response response = router.handle(std::move(request));
            if (large) memory_.look();  // its memory is returned before the next large one
            return response;
        };
        made.refuse = [this](int status, const std::string& detail, http::Request& request) {
            return refusal(status, detail, request);
        };
        return made;
    }

    http::Response refusal(int status, const std::string& detail, http::Request& request) {
        if (request.request_id.empty()) gate_.name_refused(request);
        http::Answered answered;
        answered.method = "refused";
        answered.client = request.client;
        answered.request_id = request.request_id;
        answered.traceparent = request.traceparent;
        answered.status = status;
        metrics_.count(answered);
        http::log_answer(answered);
        http::Response response = http::problem_response(status, detail);
        for (const auto& [name, value] : request.answer_headers) response.set(name, value);
        http::add_common_headers(response);
        return response;
    }

    Config config_;
    Memory memory_;
    std::stop_source closing_;
    Timer timer_;
    Metrics metrics_{TUNEWRIGHT_VERSION};
    std::unique_ptr<JobStore> store_;
    SpareCores spare_cores_;
    JobService jobs_;
    ComputeSlots turns_;
    ComputeSlots readers_, listers_, searchers_;
    LongRequestSlots places_;
    Executor batch_lane_;
    Batches batches_;
    NotifyPolicy policy_;
    Notifier notifier_;
    http::Router router_;
    http::StaticFiles page_;
    Gate gate_;
    http::Server server_;
    std::jthread serving_;
    http::Router metrics_router_;
    std::unique_ptr<http::Server> metrics_server_;  ///< of --metrics-listen; null if it is not given
    std::jthread serving_metrics_;
};

int failed(int code, const std::string& sentence) {
    stop_log();
    std::cerr << "tunewright: " << sentence << "\n";
    return code;
}

std::string url_of(const std::string& listen, int port) {
    const HostPort address = parse_listen(listen);
    const bool v6 = address.host.find(':') != std::string::npos;
    return "http://" + (v6 ? "[" + address.host + "]" : address.host) + ":" + std::to_string(port) + "/";
}

/// Blocks until SIGTERM or SIGINT; a second one ends the process at once.
void wait_for_stop(const sigset_t& signals) {
    int signal = 0;
    sigwait(&signals, &signal);
    std::signal(SIGTERM, SIG_DFL);
    std::signal(SIGINT, SIG_DFL);
    pthread_sigmask(SIG_UNBLOCK, &signals, nullptr);
}

}  // namespace

int serve(Config config) {
    // Blocked before any thread exists, including that of the log, so that only wait_for_stop sees them.
    const sigset_t signals = stop_signals();
    pthread_sigmask(SIG_BLOCK, &signals, nullptr);
    try {
        check_config(config);
        start_log(config.log_format, config.log_level);
    } catch (const std::invalid_argument& error) {
        return failed(kBadConfiguration, error.what());
    }
    config.remarks.push_back(fit_body(config.max_body, memory_limit(config.memory)));
    for (const std::string& remark : config.remarks)
        if (!remark.empty()) log_warning(remark);
    std::signal(SIGPIPE, SIG_IGN);  // a receiver or a client that disconnects is an error of one write
    raise_file_limit();
    keep_small_memory();

    std::unique_ptr<Service> service;
    int port = 0;
    try {
        std::unique_ptr<JobStore> store = open_behind_startup_server(config, signals);
        if (!store) return stop_log(), 0;
        service = std::make_unique<Service>(config, std::move(store));
        port = service->listen();
        service->start();
    } catch (const std::invalid_argument& error) {
        return failed(kBadConfiguration, error.what());
    } catch (const StoreError& error) {
        return failed(kStoreFailed, error.what());
    } catch (const std::runtime_error& error) {
        return failed(kPortFailed, error.what());
    }
    std::cout << "Tunewright " << TUNEWRIGHT_VERSION << " is ready at " << url_of(config.listen, port) << std::endl;

    wait_for_stop(signals);
    log_info("stopping: running jobs get " + std::to_string(static_cast<int>(config.drain_timeout_s)) + " s");
    const bool idle = service->stop();
    log_info(idle ? "stopped" : "stopped; a computation that did not stop in time runs again at the next start");
    stop_log();
    if (!idle) ::_exit(0);
    return 0;
}

}  // namespace tunewright::server
