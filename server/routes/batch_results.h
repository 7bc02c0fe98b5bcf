// Sends the results of a batch while it reads them from the store: page by page, as fast as the client takes them.
#pragma once

#include <memory>
#include <string>

#include "server/executor.h"
#include "server/http/body/body_stream.h"
#include "server/jobs/batch/batches.h"

namespace tunewright::server {

struct ResultsQuestion {
    std::string batch;      ///< its id; the caller has found it and may see it
    bool csv = false;       ///< one line for each controller; else NDJSON, one line for each job
    bool follow = false;    ///< each row is sent when its job has ended, and the last one ends the answer
    std::int64_t from = 0;  ///< index of the first row
};

/// Answers GET /v1/batches/{id}/results. Writes to `stream` from `lane` until all rows are out or the client has gone.
/// Returns at once.
///
/// Memory stays bounded however large the batch is: the next page is read only when the stream has room for it. A fault
/// of the store breaks the stream off early, which the client sees, because the answer lacks its end; the log says why.
/// With `follow`, rows come in the order of the batch: a row waits for the jobs before it. All that is passed by
/// reference must outlive the stream.
void send_results(ResultsQuestion question, std::shared_ptr<http::BodyStream> stream, Batches& batches,
                  JobService& jobs, Timer& timer, Executor& lane);

}  // namespace tunewright::server
