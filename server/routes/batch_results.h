// Sends the results of a batch while it reads them from the store: page by page, as fast as the client takes them.
#pragma once

#include <memory>
#include <string>

#include "server/executor.h"
#include "server/http/body/body_stream.h"
#include "server/jobs/batch/batches.h"

namespace tunewright::server {

struct ResultsQuestion {
    std::string batch;
    bool csv = false;       ///< one line for each controller; else NDJSON, one line for each job
    bool follow = false;    ///< each row is sent when its job has ended, and the last one ends the answer
    std::int64_t from = 0;  ///< index of the first row
};

/// Writes to `stream` from `lane` until all rows are out or the client has gone; a fault of the store ends the stream
/// early. Returns at once. All that is passed by reference must outlive the stream.
void send_results(ResultsQuestion question, std::shared_ptr<http::BodyStream> stream, Batches& batches,
                  JobService& jobs, Timer& timer, Executor& lane);

}  // namespace tunewright::server
