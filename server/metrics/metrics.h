// What the service counts, in Prometheus' text form.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "server/http/app/router.h"
#include "server/http/guard/server.h"
#include "server/jobs/service.h"

namespace tunewright::server {

enum class DeliveryOutcome;

/// How things stand when somebody looks. Nothing in it waits for the store: what the queue holds is as last counted.
struct Standing {
    QueueDepth queue;
    UnixMs now = 0;  ///< of the clock that the queue's moments are of
    std::size_t running = 0, workers = 0;
    http::Occupancy clients;
    std::size_t memory_limit = 0;  ///< bytes that the process may take
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
    /// A worker begins with a job that was accepted so long ago.
    void count_begun(bool entry_of_batch, double waited_s);
    void count(const Recovery& found);
    /// A try to tell somebody of an end.
    void count(DeliveryOutcome outcome);
    /// An operation of the store; its name must be one of a few.
    void count_store(std::string_view operation, double seconds, bool done);

    /// Everything counted so far, and how things stand.
    std::string text(const Standing& standing);

private:
    struct Families;
    std::unique_ptr<Families> families_;
};

}  // namespace tunewright::server
