// The line of the log for a job that has ended.
#pragma once

#include "server/jobs/running/result_outbox.h"

namespace tunewright::server {

/// One job that a worker has ended.
void log_job(const Ended& ended);

}  // namespace tunewright::server
