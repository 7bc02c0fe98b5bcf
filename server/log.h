// One line for each request and each job, on standard error, as text or as JSON; gathered and written by a thread of
// its own, so that a slow reader of the log never holds up an answer (the oldest of 8192 waiting lines are dropped
// instead). Every function may be called from any thread.
#pragma once

#include <string>
#include <string_view>

namespace tunewright::server {

namespace http {
struct Answered;
}
struct Ended;

/// Format: text or json. Level: debug, info, warn, error, off. Throws std::invalid_argument for others.
void start_log(const std::string& format, const std::string& level);
/// Writes the lines that still wait, and ends the thread.
void stop_log();

/// How many lines have been dropped since the start.
std::size_t dropped_log_lines();

/// What happens to the service itself, in one line; the line breaks of a text log are not escaped.
void log_info(std::string_view message);
/// The same for what may be a mistake of whoever started it.
void log_warning(std::string_view message);
/// The same for what its operator has to look after.
void log_error(std::string_view message);
/// One answered request: at the level warn where the status is 500 or more, debug for probes (/healthz, /readyz,
/// /metrics), info otherwise.
void log_answer(const http::Answered& answered);
/// One job that a worker has ended.
void log_job(const Ended& ended);

}  // namespace tunewright::server
