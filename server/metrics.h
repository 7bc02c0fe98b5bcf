// What the service counts, in Prometheus' text form.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "server/http/router.h"
#include "server/jobs/service.h"

namespace tunewright::server {

class Metrics {
public:
    Metrics();
    ~Metrics();
    Metrics(const Metrics&) = delete;
    Metrics& operator=(const Metrics&) = delete;

    void count(const http::Answered& answered);
    /// `method` as in api::JobOutcome.
    void count(JobStatus status, const std::string& method, double seconds);
    void count_dropped();
    /// An operation of the store; its name must be one of a few.
    void count_store(std::string_view operation, double seconds, bool done);

    /// Everything counted so far and the queue as it is now.
    std::string text(const JobService& jobs);

private:
    struct Families;
    std::unique_ptr<Families> families_;
};

}  // namespace tunewright::server
