#include "server/metrics.h"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>

#include <map>
#include <mutex>
#include <tuple>

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

}  // namespace

struct Metrics::Families {
    prometheus::Registry registry;
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
    Gauge& queued =
        family(BuildGauge(), registry, "tunewright_jobs_queued", "Accepted jobs that no worker has yet").Add({});
    Gauge& running = family(BuildGauge(), registry, "tunewright_jobs_running", "Jobs that workers have").Add({});
    Gauge& workers = family(BuildGauge(), registry, "tunewright_workers", "Threads that compute jobs").Add({});

    // The families look a metric up by building a map of labels; for each request that is too slow.
    std::mutex mutex;
    std::map<std::tuple<std::string, std::string, int>, Counter*, std::less<>> request_counters;
    std::map<std::string, Histogram*, std::less<>> latency_by_route;
    std::map<std::string, Histogram*, std::less<>> time_by_method;
    std::map<std::string, Histogram*, std::less<>> time_by_operation;
};

Metrics::Metrics() : families_(std::make_unique<Families>()) {}
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
    if (slot == nullptr)
        slot = &all.job_time_family.Add(
            {{"method", method}}, Histogram::BucketBoundaries{0.001, 0.003, 0.01, 0.03, 0.1, 0.3, 1, 3, 10, 30, 100});
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

std::string Metrics::text(const JobService& jobs) {
    families_->queued.Set(static_cast<double>(jobs.queued()));
    families_->running.Set(static_cast<double>(jobs.running()));
    families_->workers.Set(static_cast<double>(jobs.workers()));
    return prometheus::TextSerializer().Serialize(families_->registry.Collect());
}

}  // namespace tunewright::server
