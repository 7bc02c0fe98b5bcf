// The states of a job and the only ways between them. The stores hold to them by constraints as well; docs/jobs.md
// describes them to users.
//
//               claim                 succeed, fail, cancel
//   [queued] ----------> [running] -------------------------> [succeeded] [failed] [cancelled]
//      |  ^                  |
//      |  +------------------+  release
//      +--> [cancelled]  cancel           [failed] [cancelled] ----------> [queued]  requeue
//
// Who moves a job, and what a crash does to it:
//
//   queued     A worker of any process claims it (claims.h): attempts count one more. Whoever asks for its cancellation
//              ends it at once. A crash changes nothing.
//   running    The worker that has it, named by its attempts, ends it (result_outbox.h), or releases it when its
//              process stops (service.cpp, drain). A cancellation is only noted; the worker learns of it and ends the
//              job. When its process has died, nobody gives its signs of life (heartbeats.h): once its lease is over
//              another process releases the job (rescuer.h; on a store of one process the next start does, recover),
//              ends it as cancelled where that was asked for, and as failed from `max_attempts` crashes on. A worker
//              that then comes with the old attempts learns that it no longer has the job, and drops what it has.
//   succeeded, failed, cancelled
//              Its owner may have one that failed or was cancelled queued again; nothing else moves it. He deletes it,
//              or the sweeper does once its retention is over.
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

enum class JobEvent { claim, succeed, fail, cancel, release, requeue };

/// Where the event leads; nothing where it is not possible in that state.
std::optional<JobStatus> transition(JobStatus from, JobEvent event);

bool has_ended(JobStatus status);

std::string_view to_string(JobStatus status);
std::optional<JobStatus> job_status(std::string_view text);

}  // namespace tunewright::server
