// Results of a batch, sent while they are read: page by page, as the client takes them.
#pragma once

#include <memory>
#include <string>

#include "server/executor.h"
#include "server/http/body/body_stream.h"
#include "server/jobs/batch/batches.h"

namespace tunewright::server {

struct ResultsQuestion {
    std::string batch;
    bool csv = false;       ///< else NDJSON
    bool follow = false;    ///< each row when its job has ended, the last one ends the answer
    std::int64_t from = 0;  ///< index of the first row
};

/// Writes to `stream` from `lane` until all rows are out or the client has gone. Everything must outlive the stream.
void send_results(ResultsQuestion question, std::shared_ptr<http::BodyStream> stream, Batches& batches,
                  JobService& jobs, Timer& timer, Executor& lane);

}  // namespace tunewright::server
