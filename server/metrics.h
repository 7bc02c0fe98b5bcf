// What the service counts, in Prometheus' text form.
#pragma once

#include <memory>
#include <string>

#include "server/http/router.h"
#include "server/jobs/service.h"

namespace tunewright::server {

class Metrics {
public:
    Metrics();
    ~Metrics();
    Metrics(const Metrics&) = delete;
    Metrics& operator=(const Metrics&) = delete;

    void count(const http::Exchange& exchange);
    void count(const JobRecord& job, double seconds);

    /// Everything counted so far and the queue as it is now.
    std::string text(const JobService& jobs);

private:
    struct Families;
    std::unique_ptr<Families> families_;
};

}  // namespace tunewright::server
