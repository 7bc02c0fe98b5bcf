// The states of a job and all transitions between them. Constraints in the stores enforce them too; docs/jobs.md
// describes them for users.
//
//               claim                 succeed, fail, cancel
//   [queued] ----------> [running] -------------------------> [succeeded] [failed] [cancelled]
//      |  ^                  |
//      |  +------------------+  release
//      +--> [cancelled]  cancel           [failed] [cancelled] ----------> [queued]  requeue
//
// The processes that move a job, and the effect of a crash:
//
//   queued     A worker of any process claims it (claims.h), which increases its attempts by one. A cancellation ends
//              it at once. A crash changes nothing.
//   running    The worker that has it, identified by its attempts, ends it (result_outbox.h), or releases it when its
//              process stops (service.cpp, drain). A cancellation is only noted; the worker learns of it and ends the
//              job. A process that has died sends no heartbeats (heartbeats.h): once the lease has expired, another
//              process releases the job (rescuer.h; on a store of one process its next start does, recover), ends it as
//              cancelled if that was requested, and as failed from `max_attempts` crashes on. A worker that then comes
//              with the old attempts learns that it no longer has the job, and drops its result.
//   succeeded, failed, cancelled
//              The owner may have a job that failed or was cancelled queued again; it changes state in no other way. It
//              is deleted by the owner, or by the sweeper once its retention is over.
#pragma once

#include <optional>
#include <string_view>

namespace tunewright::server {

enum class JobStatus {
    queued,     ///< durable, waits for a worker; a crash does not change it
    running,    ///< a worker has it; after a crash it is queued again and its next attempt counts one more
    succeeded,  ///< ended with a result
    failed,     ///< ended with an error, and perhaps with the best design found before the timeout
    cancelled,  ///< ended by a cancellation, perhaps with the best design found so far
};

enum class JobEvent { claim, succeed, fail, cancel, release, requeue };

/// The state after the event; empty if the event is not possible in that state.
std::optional<JobStatus> transition(JobStatus from, JobEvent event);

bool has_ended(JobStatus status);

std::string_view to_string(JobStatus status);
std::optional<JobStatus> job_status(std::string_view text);

}  // namespace tunewright::server
