#include "server/jobs/job_log.h"

#include <fmt/format.h>

#include "server/json_text.h"
#include "server/log.h"

namespace tunewright::server {

void log_job(const Ended& ended) {
    const JobEnd& end = ended.end;
    const JobRecord& job = ended.held->job;
    const double ms = ended.seconds * 1e3;
    if (log_is_json())
        log_line(
            LogLevel::info,
            fmt::format(
                R"("event":"job","id":"{}","status":"{}","ms":{:.2f},"attempts":{},"method":{},"owner":{},"batch":"{}",)"
                R"("request_id":{},"traceparent":"{}")",
                end.id, to_string(end.status), ms, end.attempts, json_string(ended.method), json_string(job.owner),
                job.batch, json_string(job.request_id), job.traceparent));
    else
        log_line(
            LogLevel::info,
            fmt::format("job {} {} after {:.2f} ms, attempt {}{}{}{}", end.id, to_string(end.status), ms, end.attempts,
                        job.owner.empty() ? "" : ", of " + job.owner, job.batch.empty() ? "" : ", batch " + job.batch,
                        job.request_id.empty() ? "" : ", request " + job.request_id));
}

}  // namespace tunewright::server
