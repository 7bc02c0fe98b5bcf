// The log: lines on standard error, as text or as JSON, gathered and written by a thread of its own, so that a slow
// reader of the log never holds up an answer (the oldest of 8192 waiting lines are dropped instead). Every function may
// be called from any thread.
#pragma once

#include <string>
#include <string_view>

namespace tunewright::server {

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

// ---- for events with fields of their own (http/app/answer_log.h, jobs/job_log.h)

enum class LogLevel { debug, info, warning, error };

/// Whether lines are JSON objects: then `line` of log_line() is their members behind time and level.
bool log_is_json();
bool logs(LogLevel level);
/// A line as it is, behind its time and level.
void log_line(LogLevel level, std::string_view line);

}  // namespace tunewright::server
