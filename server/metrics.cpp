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

struct Metrics::Families {
    prometheus::Registry registry;
    prometheus::Family<Counter>& requests = BuildCounter()
                                                .Name("tunewright_http_requests_total")
                                                .Help("Answered requests by route, method and status")
                                                .Register(registry);
    prometheus::Family<Histogram>& latency = BuildHistogram()
                                                 .Name("tunewright_http_request_duration_seconds")
                                                 .Help("Time from a whole request to its answer, by route")
                                                 .Register(registry);
    prometheus::Family<Counter>& jobs = BuildCounter()
                                            .Name("tunewright_jobs_ended_total")
                                            .Help("Jobs that workers ended, by status")
                                            .Register(registry);
    prometheus::Family<Histogram>& job_time_family = BuildHistogram()
                                                         .Name("tunewright_job_duration_seconds")
                                                         .Help("Computing time of jobs that workers ended, by method")
                                                         .Register(registry);
    prometheus::Family<Histogram>& store_time = BuildHistogram()
                                                    .Name("tunewright_store_duration_seconds")
                                                    .Help("Time from a call of the store to its answer, by operation")
                                                    .Register(registry);
    prometheus::Family<Counter>& store_faults = BuildCounter()
                                                    .Name("tunewright_store_faults_total")
                                                    .Help("Calls that the store could not do, by operation")
                                                    .Register(registry);
    Counter& dropped = BuildCounter()
                           .Name("tunewright_jobs_dropped_total")
                           .Help("Results that came too late: the job's lease had gone to another process")
                           .Register(registry)
                           .Add({});
    Gauge& queued = BuildGauge()
                        .Name("tunewright_jobs_queued")
                        .Help("Accepted jobs that no worker has yet")
                        .Register(registry)
                        .Add({});
    Gauge& running =
        BuildGauge().Name("tunewright_jobs_running").Help("Jobs that workers have").Register(registry).Add({});
    Gauge& workers =
        BuildGauge().Name("tunewright_workers").Help("Threads that compute jobs").Register(registry).Add({});

    // The families look a metric up by building a map of labels; for each request that is too slow.
    std::mutex mutex;
    std::map<std::tuple<std::string, std::string, int>, Counter*, std::less<>> request_counters;
    std::map<std::string, Histogram*, std::less<>> latency_by_route;
    std::map<std::string, Histogram*, std::less<>> time_by_method;
    std::map<std::string, Histogram*, std::less<>> time_by_operation;
};

Metrics::Metrics() : families_(std::make_unique<Families>()) {}
Metrics::~Metrics() = default;

void Metrics::count(const http::Exchange& exchange) {
    Families& all = *families_;
    Counter* counter = nullptr;
    Histogram* latency = nullptr;
    {
        const std::lock_guard lock(all.mutex);
        const auto key = std::tie(exchange.route, exchange.method, exchange.status);
        const auto found = all.request_counters.find(key);
        if (found != all.request_counters.end()) {
            counter = found->second;
        } else {
            const std::string& route = exchange.route.empty() ? "other" : exchange.route;
            counter = &all.requests.Add(
                {{"route", route}, {"method", exchange.method}, {"status", std::to_string(exchange.status)}});
            all.request_counters.emplace(key, counter);
        }
        Histogram*& slot = all.latency_by_route[exchange.route];
        if (slot == nullptr) {
            const std::string& route = exchange.route.empty() ? "other" : exchange.route;
            slot = &all.latency.Add({{"route", route}}, Histogram::BucketBoundaries{0.0001, 0.0003, 0.001, 0.003, 0.01,
                                                                                    0.03, 0.1, 0.3, 1, 10});
        }
        latency = slot;
    }
    counter->Increment();
    latency->Observe(static_cast<double>(exchange.duration.count()) * 1e-6);
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
