// The scenarios: each puts one kind of load on a running service and says what it measured.
#pragma once

#include <string>
#include <string_view>

#include "bench/load/figures.h"

namespace tunewright::load {

struct Options {
    int port = 8080;
    long pid = 0;                  ///< of the server, whose memory is asked for; 0: not asked
    std::size_t connections = 16;  ///< of the clients that measure
    std::size_t count = 0;         ///< of requests; 0: the scenario's own
    double seconds = 5;            ///< of scenarios that have a length
    double patience = 600;         ///< s until a scenario gives up
    std::string follow = "wait";   ///< jobs: wait (Prefer: wait) or poll (the list, until nothing is queued or running)
};

/// GET /healthz on kept-alive connections, each asking again as soon as it is answered.
Figures health(const Options& options);
/// POST /v1/jobs, each answered when it is durable: 202.
Figures post_jobs(const Options& options);
/// Jobs from the post to their end, results included where they are waited for.
Figures finish_jobs(const Options& options);
/// One client that waits for single jobs while a batch of `count` runs.
Figures interactive(const Options& options);
/// `count` jobs, half of them single ones that are waited for, half in batches whose results are read.
Figures soak(const Options& options);
/// A normal client, with 500 idle connections, 200 event streams, 200 waiting requests and 50 that send a byte a
/// second.
Figures crowd(const Options& options);
/// The time of a batch of `count` heavy designs.
Figures heavy_batch(const Options& options);

// ---- what several of them need ---------------------------------------------------------------------------------

/// A SIMC design for a first-order plant with traces of 100 points; each number gives another plant.
std::string rule_job(std::size_t number);
/// So many of them as NDJSON.
std::string rule_lines(std::size_t count);
/// The first value of that name in a JSON text, without quotes; "" where there is none.
std::string json_value(std::string_view json, std::string_view name);
/// VmHWM and VmRSS of a process in MiB, 0 where they cannot be read.
double peak_memory_mib(long pid);
double memory_mib(long pid);
/// Posts NDJSON as a batch; its id. Throws std::runtime_error where it is refused.
std::string post_batch(Client& client, const std::string& lines);
/// Asks every `pause` until all jobs of the batch have ended: how many succeeded. Throws where `end` passes before.
std::size_t wait_for_batch(Client& client, const std::string& id, Clock::time_point end);

}  // namespace tunewright::load
