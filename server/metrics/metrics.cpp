#include "server/metrics/metrics.h"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <string_view>
#include <tuple>
#include <utility>

#include "server/metrics/process_figures.h"
#include "server/notify/notifier.h"

namespace tunewright::server {

using prometheus::BuildCounter;
using prometheus::BuildGauge;
using prometheus::BuildHistogram;
using prometheus::Counter;
using prometheus::Gauge;
using prometheus::Histogram;

namespace {

template <class Builder>
auto& family(Builder builder, prometheus::Registry& registry, const char* name, const char* help) {
    return builder.Name(name).Help(help).Register(registry);
}

/// For durations of up to an hour.
const Histogram::BucketBoundaries kLongTimes{0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30, 100, 300, 1000, 3600};

double seconds_since(const std::optional<UnixMs>& then, UnixMs now) {
    return then ? std::max(0.0, static_cast<double>(now - *then) * 1e-3) : 0;
}

}  // namespace

/// Caches the histograms of a family by the value of their label: a lookup in the family builds a map of labels, which
/// is too slow for every request.
class TimesByLabel {
public:
    TimesByLabel(prometheus::Family<Histogram>& family, const char* label, Histogram::BucketBoundaries bounds)
        : family_(family), label_(label), bounds_(std::move(bounds)) {}

    void observe(std::string_view value, double seconds) { of(value).Observe(seconds); }

private:
    Histogram& of(std::string_view value) {
        const std::lock_guard lock(mutex_);
        auto found = by_value_.find(value);
        if (found == by_value_.end()) {
            const std::string name(value);
            found = by_value_.emplace(name, &family_.Add({{label_, name}}, bounds_)).first;
        }
        return *found->second;
    }

    prometheus::Family<Histogram>& family_;
    const std::string label_;
    const Histogram::BucketBoundaries bounds_;
    std::mutex mutex_;
    std::map<std::string, Histogram*, std::less<>> by_value_;
};

namespace {

/// Sets a counter from an external count.
void set(Counter& counter, double value) {
    if (const double more = value - counter.Value(); more > 0) counter.Increment(more);
}

}  // namespace

struct Metrics::Families {
    prometheus::Registry registry;
    Gauge& gauge(const char* name, const char* help) { return family(BuildGauge(), registry, name, help).Add({}); }
    Counter& counter(const char* name, const char* help) {
        return family(BuildCounter(), registry, name, help).Add({});
    }

    prometheus::Family<Counter>& requests = family(BuildCounter(), registry, "tunewright_http_requests_total",
                                                   "Answered requests by route, method and status");
    TimesByLabel latency{family(BuildHistogram(), registry, "tunewright_http_request_duration_seconds",
                                "Time from a complete request to its answer, by route"),
                         "route",
                         {0.0001, 0.0003, 0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 10}};
    prometheus::Family<Counter>& jobs =
        family(BuildCounter(), registry, "tunewright_jobs_ended_total", "Jobs that workers ended, by status");
    TimesByLabel job_time{family(BuildHistogram(), registry, "tunewright_job_duration_seconds",
                                 "Computing time of jobs that workers ended, by method"),
                          "method", kLongTimes};
    TimesByLabel store_time{family(BuildHistogram(), registry, "tunewright_store_duration_seconds",
                                   "Time from a call of the store to its answer, by operation"),
                            "operation",
                            {0.0001, 0.0003, 0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 3}};
    prometheus::Family<Counter>& store_faults = family(BuildCounter(), registry, "tunewright_store_faults_total",
                                                       "Calls in which the store failed, by operation");
    Counter& dropped =
        counter("tunewright_jobs_dropped_total", "Results that came too late: another process had the job's lease");
    Counter& limited = counter("tunewright_client_limit_refusals_total",
                               "Jobs refused because their client already has --client-jobs that wait or run");
    Counter& interrupted =
        counter("tunewright_jobs_interrupted_total", "Jobs found running without a process, and queued again");
    Counter& given_up =
        counter("tunewright_jobs_given_up_total", "Jobs that were interrupted too often and have failed");
    prometheus::Family<Counter>& delivery_family =
        family(BuildCounter(), registry, "tunewright_notify_deliveries_total",
               "Attempts to deliver a notification, by outcome: delivered, failed (with another attempt), given_up");
    Counter& delivered = delivery_family.Add({{"outcome", "delivered"}});
    Counter& failed_deliveries = delivery_family.Add({{"outcome", "failed"}});
    Counter& abandoned_deliveries = delivery_family.Add({{"outcome", "given_up"}});
    prometheus::Family<Histogram>& wait_family =
        family(BuildHistogram(), registry, "tunewright_job_wait_seconds",
               "Time from a job's acceptance to the start of its computation, by class: single, or entry of a batch");
    Histogram& single_wait = wait_family.Add({{"class", "single"}}, kLongTimes);
    Histogram& entry_wait = wait_family.Add({{"class", "entry"}}, kLongTimes);
    Gauge& queued =
        gauge("tunewright_jobs_queued", "Accepted jobs that no worker has claimed yet, in all processes together");
    prometheus::Family<Gauge>& age_family =
        family(BuildGauge(), registry, "tunewright_queue_age_seconds",
               "Waiting time of the next job, by class, in all processes together; 0 if none waits");
    Gauge& single_age = age_family.Add({{"class", "single"}});
    Gauge& entry_age = age_family.Add({{"class", "entry"}});
    Gauge& running = gauge("tunewright_jobs_running", "Jobs that workers have");
    Gauge& workers = gauge("tunewright_workers", "Threads that compute jobs");
    Gauge& connections = gauge("tunewright_http_connections", "Open connections of clients");
    Gauge& body_bytes = gauge("tunewright_http_body_bytes", "Bytes of requests that are not answered yet");
    Gauge& unsent_bytes = gauge("tunewright_http_unsent_bytes", "Bytes of answers that clients have not read");
    Gauge& memory_limit = gauge("tunewright_memory_limit_bytes", "Memory that the process may use");
    Gauge& streams = gauge("tunewright_event_streams", "Followers of jobs by server-sent events");
    Gauge& synchronous = gauge("tunewright_synchronous_waiting", "Synchronous calls that wait to be computed");
    Gauge& batch_tasks = gauge("tunewright_batch_tasks_waiting", "Pieces of batches that wait for a thread");
    Counter& log_dropped = counter("tunewright_log_lines_dropped_total", "Log lines dropped because of a slow reader");
    Counter& cpu = counter("process_cpu_seconds_total", "User and system time");
    Gauge& resident = gauge("process_resident_memory_bytes", "Resident memory");
    Gauge& address_space = gauge("process_virtual_memory_bytes", "Virtual memory");
    Gauge& files = gauge("process_open_fds", "Open file descriptors");
    Gauge& max_files = gauge("process_max_fds", "Maximum number of open file descriptors");
    Gauge& threads = gauge("process_threads", "Threads of this process");
    Gauge& started = gauge("process_start_time_seconds", "Start of this process, in seconds since 1970");

    // Stored here for the same reason as the histograms in TimesByLabel.
    std::mutex mutex;
    std::map<std::tuple<std::string, std::string, int>, Counter*, std::less<>> request_counters;
};

Metrics::Metrics(const std::string& version) : families_(std::make_unique<Families>()) {
    family(BuildGauge(), families_->registry, "tunewright_build_info", "1, with the version of the program as a label")
        .Add({{"version", version}})
        .Set(1);
}
Metrics::~Metrics() = default;

void Metrics::count(const http::Answered& answered) {
    Families& all = *families_;
    const std::string_view route = answered.route.empty() ? "other" : std::string_view(answered.route);
    Counter* counter = nullptr;
    {
        const std::lock_guard lock(all.mutex);
        const auto key = std::tie(answered.route, answered.method, answered.status);
        const auto found = all.request_counters.find(key);
        if (found != all.request_counters.end()) {
            counter = found->second;
        } else {
            counter = &all.requests.Add({{"route", std::string(route)},
                                         {"method", answered.method},
                                         {"status", std::to_string(answered.status)}});
            all.request_counters.emplace(key, counter);
        }
    }
    counter->Increment();
    all.latency.observe(route, static_cast<double>(answered.duration.count()) * 1e-6);
}

void Metrics::count(JobStatus status, const std::string& method, double seconds) {
    Families& all = *families_;
    all.jobs.Add({{"status", std::string(to_string(status))}}).Increment();
    all.job_time.observe(method, seconds);
}

void Metrics::count_store(std::string_view operation, double seconds, bool done) {
    Families& all = *families_;
    if (!done) all.store_faults.Add({{"operation", std::string(operation)}}).Increment();
    all.store_time.observe(operation, seconds);
}

void Metrics::count_dropped() { families_->dropped.Increment(); }

void Metrics::count_limited() { families_->limited.Increment(); }

void Metrics::count_begun(bool entry_of_batch, double waited_s) {
    (entry_of_batch ? families_->entry_wait : families_->single_wait).Observe(waited_s);
}

void Metrics::count(DeliveryOutcome outcome) {
    Families& all = *families_;
    (outcome == DeliveryOutcome::delivered ? all.delivered
     : outcome == DeliveryOutcome::failed  ? all.failed_deliveries
                                           : all.abandoned_deliveries)
        .Increment();
}

void Metrics::count(const Recovery& found) {
    families_->interrupted.Increment(static_cast<double>(found.interrupted));
    families_->given_up.Increment(static_cast<double>(found.given_up));
}

std::string Metrics::text(const Standing& standing) {
    Families& all = *families_;
    const auto put = [](Gauge& gauge, std::size_t value) { gauge.Set(static_cast<double>(value)); };
    put(all.queued, standing.queue.single + standing.queue.entries);
    all.single_age.Set(seconds_since(standing.queue.next_single, standing.now));
    all.entry_age.Set(seconds_since(standing.queue.next_entry, standing.now));
    put(all.running, standing.running);
    put(all.workers, standing.workers);
    put(all.connections, standing.clients.connections);
    put(all.body_bytes, standing.clients.body_bytes);
    put(all.unsent_bytes, standing.clients.unsent_bytes);
    put(all.memory_limit, standing.memory_limit);
    put(all.streams, standing.event_streams);
    put(all.synchronous, standing.synchronous_waiting);
    put(all.batch_tasks, standing.batch_tasks_waiting);
    set(all.log_dropped, static_cast<double>(standing.log_lines_dropped));
    const ProcessFigures process = process_figures();
    set(all.cpu, process.cpu_seconds);
    put(all.resident, process.resident_bytes);
    put(all.address_space, process.virtual_bytes);
    put(all.files, process.open_files);
    put(all.max_files, process.max_files);
    put(all.threads, process.threads);
    all.started.Set(process.start_time);
    return prometheus::TextSerializer().Serialize(all.registry.Collect());
}

}  // namespace tunewright::server
