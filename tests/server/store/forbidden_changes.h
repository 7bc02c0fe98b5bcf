// Changes that the tables of every store refuse from any writer: one list for all, because their columns have the same
// names. A missing rule is found here and not through a job that is in two states.
#pragma once

namespace tunewright::server {

/// The single jobs are "ended" (succeeded, in its first attempt), "running" (in its first attempt) and "waiting".
inline constexpr const char* kForbiddenChanges[] = {
    // An end has one of three states and a time; a success had an attempt.
    "INSERT INTO ended (seq, single, status, attempts, cancel_requested, finished_at) "
    "SELECT seq, TRUE, 'queued', 0, FALSE, 1 FROM jobs WHERE id = 'waiting'",
    "INSERT INTO ended (seq, single, status, attempts, cancel_requested, started_at, finished_at) "
    "SELECT seq, TRUE, 'running', 1, FALSE, 1, 1 FROM jobs WHERE id = 'waiting'",
    "INSERT INTO ended (seq, single, status, attempts, cancel_requested, finished_at) "
    "SELECT seq, TRUE, 'cancelled', 0, FALSE, NULL FROM jobs WHERE id = 'waiting'",
    "INSERT INTO ended (seq, single, status, attempts, cancel_requested, started_at, finished_at) "
    "SELECT seq, TRUE, 'succeeded', 0, FALSE, 1, 1 FROM jobs WHERE id = 'waiting'",
    "INSERT INTO ended (seq, single, status, attempts, cancel_requested, finished_at) "
    "SELECT seq, TRUE, 'succeeded', 1, FALSE, 1 FROM jobs WHERE id = 'waiting'",
    "INSERT INTO ended (seq, single, status, attempts, cancel_requested, finished_at) "
    "SELECT seq, TRUE, 'failed', -1, FALSE, 1 FROM jobs WHERE id = 'waiting'",
    "INSERT INTO ended (seq, single, status, attempts, cancel_requested, finished_at) "
    "SELECT seq, TRUE, 'failed', 1, FALSE, 1 FROM jobs WHERE id = 'ended'",
    "UPDATE ended SET status = 'queued'",
    "UPDATE ended SET finished_at = NULL",
    "UPDATE ended SET attempts = 0",
    "UPDATE ended SET started_at = NULL",

    // A running job has a worker and at least one more attempt than crashes.
    "INSERT INTO running (seq, class, turn, flow, worker, attempts, crashes, started_at) "
    "SELECT seq, class, turn, flow, 'worker', 0, 0, 1 FROM jobs WHERE id = 'waiting'",
    "INSERT INTO running (seq, class, turn, flow, worker, attempts, crashes, started_at) "
    "SELECT seq, class, turn, flow, NULL, 1, 0, 1 FROM jobs WHERE id = 'waiting'",
    "INSERT INTO running (seq, class, turn, flow, worker, attempts, crashes, started_at) "
    "SELECT seq, class, turn, flow, 'worker', 2, 2, 1 FROM jobs WHERE id = 'waiting'",
    "INSERT INTO running (seq, class, turn, flow, worker, attempts, crashes, started_at) "
    "SELECT seq, class, turn, flow, 'worker', 1, -1, 1 FROM jobs WHERE id = 'waiting'",
    "INSERT INTO running (seq, class, turn, flow, worker, attempts, crashes, started_at) "
    "SELECT seq, class, turn, flow, 'worker', 1, 0, NULL FROM jobs WHERE id = 'waiting'",
    "INSERT INTO running (seq, class, turn, flow, worker, attempts, crashes, started_at) "
    "SELECT seq, class, turn, flow, 'another', 1, 0, 1 FROM jobs WHERE id = 'running'",
    "UPDATE running SET attempts = 0",
    "UPDATE running SET worker = NULL",
    "UPDATE running SET crashes = attempts",
    "UPDATE running SET started_at = NULL",

    // A waiting job has crashed at most as often as it was claimed, and has one position in the queue.
    "UPDATE waiting SET attempts = -1",
    "UPDATE waiting SET crashes = -1",
    "UPDATE waiting SET crashes = attempts + 1",
    "INSERT INTO waiting (class, turn, seq, flow) SELECT class, turn, seq, flow FROM jobs WHERE id = 'waiting'",

    // The constant data of a job, and the subject of a notification.
    "UPDATE jobs SET id = '' WHERE id = 'waiting'",
    "UPDATE jobs SET id = 'running' WHERE id = 'waiting'",
    "UPDATE jobs SET timeout_s = 0 WHERE id = 'waiting'",
    "UPDATE jobs SET batch_index = 0 WHERE id = 'waiting'",
    "INSERT INTO deliveries (target, created_at, due_at) VALUES ('nobody', 1, 1)",
    "INSERT INTO deliveries (target, job, batch, created_at, due_at) VALUES ('both', 'ended', 'batch', 1, 1)",
};

}  // namespace tunewright::server
