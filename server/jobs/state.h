// The states of a job and the only ways between them.
//
//               claim                 succeed, fail, cancel
//   [queued] ----------> [running] -------------------------> [succeeded] [failed] [cancelled]
//      |  ^                  |
//      |  +------------------+  release: the service stops, or was killed: the job runs again
//      +--> [cancelled]  cancel
#pragma once

#include <optional>
#include <string_view>

namespace tunewright::server {

enum class JobStatus {
    queued,     ///< durable, waits for a worker; survives a crash as it is
    running,    ///< a worker has it; after a crash it is queued again and its next attempt counts one more
    succeeded,  ///< ended with a result
    failed,     ///< ended with an error, and perhaps with the best design found before a time-out
    cancelled,  ///< ended because somebody asked, perhaps with the best design found so far
};

enum class JobEvent { claim, succeed, fail, cancel, release };

/// Where the event leads; nothing where it is not possible in that state. An ended job is never moved again.
std::optional<JobStatus> transition(JobStatus from, JobEvent event);

bool has_ended(JobStatus status);

std::string_view to_string(JobStatus status);
std::optional<JobStatus> job_status(std::string_view text);

}  // namespace tunewright::server
