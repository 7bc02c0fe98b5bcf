// Sends the results of a batch while it reads them from the store: page by page, as fast as the client reads.
#pragma once

#include <functional>
#include <string>

#include "server/http/message.h"
#include "server/jobs/batch/batches.h"
#include "server/threads/executor.h"

namespace tunewright::server {

struct ResultsQuestion {
    std::string batch;                    ///< its id; the caller has checked that it exists and is visible
    bool csv = false;                     ///< one line for each controller; else NDJSON, one line for each job
    bool of_checks = false;               ///< with csv: one line for each loop that was checked
    bool follow = false;                  ///< each row is sent when its job has ended; the answer ends after the last
                                          ///< row
    std::int64_t from = 0;                ///< index of the first row
    std::function<bool()> admitted = {};  ///< false if the caller's key has been removed; may be empty
};

/// The body of GET /v1/batches/{id}/results: rows until all are sent, the client disconnects, the batch is deleted or
/// the store fails. In the last two cases the client notices that the answer lacks its end, and the log has the reason.
/// Pages are read on `lane`.
///
/// Memory is bounded for a batch of any size: the next page is read when the client has read the previous one. With
/// `follow`, rows come in the order of the batch: a row waits for the jobs before it. References must outlive the
/// answer.
http::BodyProducer results_of(ResultsQuestion question, Batches& batches, JobService& jobs, Executor& lane);

}  // namespace tunewright::server
