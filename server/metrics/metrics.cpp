#include "server/metrics/metrics.h"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <tuple>

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

/// Of what may take an hour.
const Histogram::BucketBoundaries kLongTimes{0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30, 100, 300, 1000, 3600};

double seconds_since(const std::optional<UnixMs>& then, UnixMs now) {
    return then ? std::max(0.0, static_cast<double>(now - *then) * 1e-3) : 0;
}

/// A counter that somebody else counts.
void set(Counter& counter, double value) {
    if (const double more = value - counter.Value(); more > 0) counter.Increment(more);
}

}  // namespace

struct Metrics::Families {
    prometheus::Registry registry;
    Gauge& gauge(const char* name, const char* help) { return family(BuildGauge(), registry, name, help).Add({}); }

    prometheus::Family<Counter>& requests = family(BuildCounter(), registry, "tunewright_http_requests_total",
                                                   "Answered requests by route, method and status");
    prometheus::Family<Histogram>& latency =
        family(BuildHistogram(), registry, "tunewright_http_request_duration_seconds",
               "Time from a whole request to its answer, by route");
    prometheus::Family<Counter>& jobs =
        family(BuildCounter(), registry, "tunewright_jobs_ended_total", "Jobs that workers ended, by status");
    prometheus::Family<Histogram>& job_time_family =
        family(BuildHistogram(), registry, "tunewright_job_duration_seconds",
               "Computing time of jobs that workers ended, by method");
    prometheus::Family<Histogram>& store_time = family(BuildHistogram(), registry, "tunewright_store_duration_seconds",
                                                       "Time from a call of the store to its answer, by operation");
    prometheus::Family<Counter>& store_faults = family(BuildCounter(), registry, "tunewright_store_faults_total",
                                                       "Calls that the store could not do, by operation");
    Counter& dropped = family(BuildCounter(), registry, "tunewright_jobs_dropped_total",
                              "Results that came too late: the job's lease had gone to another process")
                           .Add({});
    Counter& interrupted = family(BuildCounter(), registry, "tunewright_jobs_interrupted_total",
                                  "Jobs found running without a process, which wait again")
                               .Add({});
    Counter& given_up = family(BuildCounter(), registry, "tunewright_jobs_given_up_total",
                               "Jobs that were interrupted too often and have failed")
                            .Add({});
    prometheus::Family<Counter>& told_family =
        family(BuildCounter(), registry, "tunewright_notify_deliveries_total",
               "Tries to tell somebody of an end, by outcome: delivered, failed (it is tried again), given_up");
    Counter& delivered = told_family.Add({{"outcome", "delivered"}});
    Counter& not_told = told_family.Add({{"outcome", "failed"}});
    Counter& never_told = told_family.Add({{"outcome", "given_up"}});
    prometheus::Family<Histogram>& wait_family =
        family(BuildHistogram(), registry, "tunewright_job_wait_seconds",
               "Time from a job's acceptance to the begin of its computation, by class: single, or entry of a batch");
    Histogram& single_wait = wait_family.Add({{"class", "single"}}, kLongTimes);
    Histogram& entry_wait = wait_family.Add({{"class", "entry"}}, kLongTimes);
    Gauge& queued = gauge("tunewright_jobs_queued", "Accepted jobs that no worker has yet, in all processes together");
    prometheus::Family<Gauge>& age_family =
        family(BuildGauge(), registry, "tunewright_queue_age_seconds",
               "How long the job that is next has waited, by class, in all processes together; 0 where none waits");
    Gauge& single_age = age_family.Add({{"class", "single"}});
    Gauge& entry_age = age_family.Add({{"class", "entry"}});
    Gauge& running = gauge("tunewright_jobs_running", "Jobs that workers have");
    Gauge& workers = gauge("tunewright_workers", "Threads that compute jobs");
    Gauge& connections = gauge("tunewright_http_connections", "Open connections of clients");
    Gauge& body_bytes = gauge("tunewright_http_body_bytes", "Bytes of requests that are not answered yet");
    Gauge& unsent_bytes = gauge("tunewright_http_unsent_bytes", "Bytes of answers that clients do not take");
    Gauge& streams = gauge("tunewright_event_streams", "Followers of jobs by server-sent events");
    Gauge& synchronous = gauge("tunewright_synchronous_waiting", "Synchronous calls that wait to be computed");
    Gauge& batch_tasks = gauge("tunewright_batch_tasks_waiting", "Pieces of batches that wait for a thread");
    Counter& log_dropped = family(BuildCounter(), registry, "tunewright_log_lines_dropped_total",
                                  "Lines that a slow reader of the log made room for")
                               .Add({});
    Counter& cpu = family(BuildCounter(), registry, "process_cpu_seconds_total", "User and system time").Add({});
    Gauge& resident = gauge("process_resident_memory_bytes", "Resident memory");
    Gauge& address_space = gauge("process_virtual_memory_bytes", "Virtual memory");
    Gauge& files = gauge("process_open_fds", "Open file descriptors");
    Gauge& most_files = gauge("process_max_fds", "Most file descriptors that may be open");
    Gauge& threads = gauge("process_threads", "Threads of this process");
    Gauge& started = gauge("process_start_time_seconds", "Start of this process, in seconds since 1970");

    // The families look a metric up by building a map of labels; for each request that is too slow.
    std::mutex mutex;
    std::map<std::tuple<std::string, std::string, int>, Counter*, std::less<>> request_counters;
    std::map<std::string, Histogram*, std::less<>> latency_by_route;
    std::map<std::string, Histogram*, std::less<>> time_by_method;
    std::map<std::string, Histogram*, std::less<>> time_by_operation;
};

Metrics::Metrics(const std::string& version) : families_(std::make_unique<Families>()) {
    family(BuildGauge(), families_->registry, "tunewright_build_info", "1, with the version of the program as a label")
        .Add({{"version", version}})
        .Set(1);
}
Metrics::~Metrics() = default;

void Metrics::count(const http::Answered& answered) {
    Families& all = *families_;
    Counter* counter = nullptr;
    Histogram* latency = nullptr;
    {
        const std::lock_guard lock(all.mutex);
        const auto key = std::tie(answered.route, answered.method, answered.status);
        const auto found = all.request_counters.find(key);
        if (found != all.request_counters.end()) {
            counter = found->second;
        } else {
            const std::string& route = answered.route.empty() ? "other" : answered.route;
            counter = &all.requests.Add(
                {{"route", route}, {"method", answered.method}, {"status", std::to_string(answered.status)}});
            all.request_counters.emplace(key, counter);
        }
        Histogram*& slot = all.latency_by_route[answered.route];
        if (slot == nullptr) {
            const std::string& route = answered.route.empty() ? "other" : answered.route;
            slot = &all.latency.Add({{"route", route}}, Histogram::BucketBoundaries{0.0001, 0.0003, 0.001, 0.003, 0.01,
                                                                                    0.03, 0.1, 0.3, 1, 10});
        }
        latency = slot;
    }
    counter->Increment();
    latency->Observe(static_cast<double>(answered.duration.count()) * 1e-6);
}

void Metrics::count(JobStatus status, const std::string& method, double seconds) {
    Families& all = *families_;
    all.jobs.Add({{"status", std::string(to_string(status))}}).Increment();
    const std::lock_guard lock(all.mutex);
    Histogram*& slot = all.time_by_method[method];
    if (slot == nullptr) slot = &all.job_time_family.Add({{"method", method}}, kLongTimes);
    slot->Observe(seconds);
}

void Metrics::count_store(std::string_view operation, double seconds, bool done) {
    Families& all = *families_;
    const std::string name(operation);
    if (!done) all.store_faults.Add({{"operation", name}}).Increment();
    const std::lock_guard lock(all.mutex);
    Histogram*& slot = all.time_by_operation[name];
    if (slot == nullptr)
        slot = &all.store_time.Add({{"operation", name}}, Histogram::BucketBoundaries{0.0001, 0.0003, 0.001, 0.003,
                                                                                      0.01, 0.03, 0.1, 0.3, 1, 3});
    slot->Observe(seconds);
}

void Metrics::count_dropped() { families_->dropped.Increment(); }

void Metrics::count_begun(bool entry_of_batch, double waited_s) {
    (entry_of_batch ? families_->entry_wait : families_->single_wait).Observe(waited_s);
}

void Metrics::count(Told outcome) {
    Families& all = *families_;
    (outcome == Told::delivered ? all.delivered : outcome == Told::failed ? all.not_told : all.never_told).Increment();
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
    put(all.streams, standing.event_streams);
    put(all.synchronous, standing.synchronous_waiting);
    put(all.batch_tasks, standing.batch_tasks_waiting);
    set(all.log_dropped, static_cast<double>(standing.log_lines_dropped));
    const ProcessFigures process = process_figures();
    set(all.cpu, process.cpu_seconds);
    put(all.resident, process.resident_bytes);
    put(all.address_space, process.virtual_bytes);
    put(all.files, process.open_files);
    put(all.most_files, process.most_files);
    put(all.threads, process.threads);
    all.started.Set(process.start_time);
    return prometheus::TextSerializer().Serialize(all.registry.Collect());
}

}  // namespace tunewright::server
