// The routes of the contract, each a translation between HTTP and the facade of api/.
#pragma once

#include <functional>
#include <string>

#include "server/access/compute_slots.h"
#include "server/access/gate.h"
#include "server/access/long_request_slots.h"
#include "server/http/app/router.h"
#include "server/jobs/batch/batches.h"
#include "server/jobs/service.h"
#include "server/metrics/memory.h"
#include "server/notify/policy.h"
#include "server/routes/computations.h"
#include "server/threads/executor.h"

namespace tunewright::server {

/// Turns for work that takes a core, a connection to the store or much memory for a while.
struct SharedTurns {
    ComputeSlots& computing;  ///< computations, and parsing of large bodies, while the client waits
    ComputeSlots& readers;    ///< answers with a whole job
    ComputeSlots& listers;    ///< lists
    ComputeSlots& searchers;  ///< lists that search for a text in all stored jobs, which may take seconds
};

/// /v1/jobs and below. A client that waits for a job takes one of `places`; `policy` decides on notification targets.
void add_job_routes(http::Router& router, JobService& jobs, LongRequestSlots& places, const SharedTurns& turns,
                    NotifyPolicy& policy, const api::JobLimits& limits);

/// /v1/jobs/{id}/events: progress as server-sent events.
void add_event_routes(http::Router& router, JobService& jobs, LongRequestSlots& places);

/// /v1/jobs/{id}/result.csv
void add_trace_routes(http::Router& router, JobService& jobs, ComputeSlots& readers);

/// /v1/jobs/{id}/controllers/{index}/code
void add_code_routes(http::Router& router, JobService& jobs, ComputeSlots& readers);

/// /v1/jobs/{id}/report.html, and change-sheet.html of a job and of a batch
void add_report_routes(http::Router& router, JobService& jobs, Batches& batches, ComputeSlots& readers);

/// /v1/queue and below, for administrators.
void add_queue_routes(http::Router& router, JobService& jobs);

struct BatchLimits {
    api::JobLimits job;
    std::size_t longest_entry = 0;  ///< bytes of one request of a batch
};

/// /v1/batches and below. Bodies are read and results are made on `lane`.
void add_batch_routes(http::Router& router, Batches& batches, JobService& jobs, LongRequestSlots& places,
                      ComputeSlots& listers, Executor& lane, NotifyPolicy& policy, const BatchLimits& limits);

/// /v1/evaluate, /v1/design, /v1/frontier, /v1/range, /v1/check, /v1/verify, /v1/identify, /v1/experiments/... and the
/// conversions below /v1/controllers, and the certificates of /v1/jobs/{id}/controllers/{index}: computed while the
/// client waits. /v1/plants/parse: at once.
void add_synchronous_routes(http::Router& router, JobService& jobs, const Computations& computations);

/// POST /mcp: the Model Context Protocol. Its tools compute in the same turns as the calls, and its jobs wait in the
/// same places.
void add_mcp_routes(http::Router& router, JobService& jobs, LongRequestSlots& places, const SharedTurns& turns,
                    const Computations& computations, const api::JobLimits& limits);

/// /v1/methods, /v1/controllers, /v1/examples, /openapi.json: constant for the life of the process.
void add_description_routes(http::Router& router);

/// /healthz, with the largest body of a request that the service takes and the time for which it keeps jobs that ended;
/// 0: without limit.
void add_liveness_route(http::Router& router, std::size_t max_body, double retention_s);

/// /healthz, /readyz, /metrics. None of them asks the store: they answer while it hangs.
void add_health_routes(http::Router& router, std::size_t max_body, double retention_s, const JobService& jobs,
                       const JobStore& store, Gate& gate, const Memory& memory, std::function<std::string()> metrics);

}  // namespace tunewright::server
