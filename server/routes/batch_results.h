// Sends the results of a batch while it reads them from the store: page by page, as fast as the client takes them.
#pragma once

#include <functional>
#include <string>

#include "server/http/message.h"
#include "server/jobs/batch/batches.h"
#include "server/threads/executor.h"

namespace tunewright::server {

struct ResultsQuestion {
    std::string batch;                    ///< its id; the caller has found it and may see it
    bool csv = false;                     ///< one line for each controller; else NDJSON, one line for each job
    bool follow = false;                  ///< each row is sent when its job has ended, and the last one ends the answer
    std::int64_t from = 0;                ///< index of the first row
    std::function<bool()> admitted = {};  ///< false where the caller's key is known no longer; may be empty
};

/// The body of GET /v1/batches/{id}/results: rows until all are out, the client has gone, the batch is deleted or the
/// store fails, which the client sees, because the answer then lacks its end; the log says why. Pages are read on
/// `lane`.
///
/// Memory stays bounded however large the batch is: the next page is read when the client has taken the one before.
/// With `follow`, rows come in the order of the batch: a row waits for the jobs before it. All that is passed by
/// reference must outlive the answer.
http::BodyProducer results_of(ResultsQuestion question, Batches& batches, JobService& jobs, Executor& lane);

}  // namespace tunewright::server
