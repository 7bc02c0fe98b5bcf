// The log: lines on standard error, as text or as JSON, collected and written by a separate thread, so that a slow
// reader of the log never delays an answer (the oldest of 8192 waiting lines are dropped instead). Every function may
// be called from any thread.
#pragma once

#include <string>
#include <string_view>

namespace tunewright::server {

/// Format: text or json. Level: debug, info, warn, error, off. Throws std::invalid_argument for others.
void start_log(const std::string& format, const std::string& level);
/// Writes the lines that still wait, and ends the thread; later lines are lost.
void stop_log();

/// Number of lines dropped since the start.
std::size_t dropped_log_lines();

/// An event of the service itself, in one line; line breaks are not escaped in a text log.
void log_info(std::string_view message);
/// An event that may be a mistake of the operator.
void log_warning(std::string_view message);
/// An error that needs the operator's attention.
void log_error(std::string_view message);

// ---- for events with their own fields (http/app/answer_log.h, jobs/job_log.h)

enum class LogLevel { debug, info, warning, error };

/// True if lines are JSON objects: then `line` of log_line() holds the members after time and level.
bool log_is_json();
bool logs(LogLevel level);
/// Writes a line unchanged, after its time and level.
void log_line(LogLevel level, std::string_view line);

}  // namespace tunewright::server
