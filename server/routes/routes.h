// What the service answers: the routes of the contract, each translated between HTTP and the facade of api/.
#pragma once

#include <functional>
#include <stop_token>
#include <string>

#include "server/access/compute_slots.h"
#include "server/access/gate.h"
#include "server/access/long_request_slots.h"
#include "server/http/app/router.h"
#include "server/jobs/batch/batches.h"
#include "server/jobs/service.h"
#include "server/metrics/memory.h"
#include "server/notify/policy.h"
#include "server/threads/executor.h"
#include "server/threads/spare_cores.h"
#include "server/threads/timer.h"

namespace tunewright::server {

/// Turns of what takes a core, a connection to the store or much memory for a while.
struct SharedTurns {
    ComputeSlots& computing;  ///< what is computed, or read from a large body, while its client waits
    ComputeSlots& readers;    ///< answers with a job as a whole
    ComputeSlots& listers;    ///< lists
    ComputeSlots& searchers;  ///< lists that look for a text in all jobs that are kept, which may take seconds
};

/// /v1/jobs and what is below it. Who waits for a job takes one of `places`; whom a job may tell of its end, `policy`
/// says.
void add_job_routes(http::Router& router, JobService& jobs, LongRequestSlots& places, const SharedTurns& turns,
                    NotifyPolicy& policy, const api::JobLimits& limits);

/// /v1/jobs/{id}/events: progress as server-sent events.
void add_event_routes(http::Router& router, JobService& jobs, LongRequestSlots& places);

/// /v1/jobs/{id}/result.csv
void add_trace_routes(http::Router& router, JobService& jobs, ComputeSlots& readers);

/// /v1/jobs/{id}/controllers/{index}/code
void add_code_routes(http::Router& router, JobService& jobs, ComputeSlots& readers);

/// /v1/jobs/{id}/report.html
void add_report_routes(http::Router& router, JobService& jobs, ComputeSlots& readers);

/// /v1/queue and what is below it, for whoever runs the service.
void add_queue_routes(http::Router& router, JobService& jobs);

struct BatchLimits {
    api::JobLimits job;
    std::size_t longest_entry = 0;  ///< bytes of one request of a batch
};

/// /v1/batches and what is below it. Bodies are read and results are made on `lane`.
void add_batch_routes(http::Router& router, Batches& batches, JobService& jobs, LongRequestSlots& places,
                      ComputeSlots& listers, Executor& lane, NotifyPolicy& policy, const BatchLimits& limits);

/// /v1/evaluate, /v1/design, /v1/frontier, /v1/range, /v1/identify, /v1/experiments/... and the conversions below
/// /v1/controllers: computed while the client waits, when its turn has come, with a deadline, or until `closing`.
/// /v1/plants/parse: at once.
void add_synchronous_routes(http::Router& router, ComputeSlots& turns, Timer& timer, SpareCores& spare_cores,
                            const std::stop_token& closing);

/// /v1/methods, /v1/controllers, /v1/examples, /openapi.json: the same for the life of the process.
void add_description_routes(http::Router& router);

/// /healthz
void add_liveness_route(http::Router& router);

/// /healthz, /readyz, /metrics. None of them asks the store: they answer while it hangs.
void add_health_routes(http::Router& router, const JobService& jobs, const JobStore& store, Gate& gate,
                       const Memory& memory, std::function<std::string()> metrics);

}  // namespace tunewright::server
