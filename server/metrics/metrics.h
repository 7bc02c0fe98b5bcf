// The metrics of the service, in Prometheus' text form.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "server/http/app/router.h"
#include "server/http/guard/server.h"
#include "server/jobs/service.h"

namespace tunewright::server {

enum class DeliveryOutcome;

/// The current state for a scrape. No value waits for the store: those of the queue are from its last count.
struct Standing {
    QueueDepth queue;
    UnixMs now = 0;  ///< of the clock to which the queue's times refer
    std::size_t running = 0, workers = 0;
    http::Occupancy clients;
    std::size_t memory_limit = 0;  ///< bytes that the process may use
    std::size_t event_streams = 0;
    std::size_t synchronous_waiting = 0;  ///< calls that wait for their turn to be computed
    std::size_t batch_tasks_waiting = 0;  ///< pieces of batches that wait for a thread
    std::size_t log_lines_dropped = 0;
};

class Metrics {
public:
    /// `version`: of the program.
    explicit Metrics(const std::string& version);
    ~Metrics();
    Metrics(const Metrics&) = delete;
    Metrics& operator=(const Metrics&) = delete;

    void count(const http::Answered& answered);
    /// `method` as in api::JobOutcome.
    void count(JobStatus status, const std::string& method, double seconds);
    void count_dropped();
    void count_limited();
    /// A worker begins a job that was accepted this long ago.
    void count_begun(bool entry_of_batch, double waited_s);
    void count(const Recovery& found);
    /// An attempt to deliver a notification.
    void count(DeliveryOutcome outcome);
    /// An operation of the store; its name must be one of a small set.
    void count_store(std::string_view operation, double seconds, bool done);

    /// All counters, and the current state.
    std::string text(const Standing& standing);

private:
    struct Families;
    std::unique_ptr<Families> families_;
};

}  // namespace tunewright::server
