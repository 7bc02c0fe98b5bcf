#include "server/log.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "server/json_text.h"
#include "server/log_sink.h"

namespace tunewright::server {
namespace {

constexpr std::size_t kWaitingLines = 8192;
bool as_json = false;
std::shared_ptr<GatheringSink> sink;

spdlog::level::level_enum level_of(LogLevel level) {
    switch (level) {
        case LogLevel::debug: return spdlog::level::debug;
        case LogLevel::info: return spdlog::level::info;
        case LogLevel::warning: return spdlog::level::warn;
        case LogLevel::error: break;
    }
    return spdlog::level::err;
}

void log_message(spdlog::level::level_enum level, std::string_view message) {
    if (as_json)
        spdlog::log(level, "\"message\":{}", json_string(message));
    else
        spdlog::log(level, "{}", message);
}

}  // namespace

void start_log(const std::string& format, const std::string& level) {
    if (format != "text" && format != "json")
        throw std::invalid_argument("The log's format is \"" + format + "\"; it must be text or json.");
    const auto chosen = spdlog::level::from_str(level);
    if (chosen == spdlog::level::off && level != "off")
        throw std::invalid_argument("The log's level is \"" + level +
                                    "\"; it must be debug, info, warn, error or off.");
    as_json = format == "json";
    sink = std::make_shared<GatheringSink>(STDERR_FILENO, kWaitingLines);
    auto logger = std::make_shared<spdlog::logger>("", sink);
    logger->set_level(chosen);
    logger->set_pattern(as_json ? R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ","level":"%l",%v})" : "%Y-%m-%dT%H:%M:%S.%eZ %l %v",
                        spdlog::pattern_time_type::utc);
    spdlog::set_default_logger(std::move(logger));
}

// The logger stays: a thread that was not waited for may still use it.
void stop_log() {
    if (sink) sink->stop();
}

std::size_t dropped_log_lines() { return sink ? sink->dropped() : 0; }

bool log_is_json() { return as_json; }

bool logs(LogLevel level) { return spdlog::should_log(level_of(level)); }

void log_line(LogLevel level, std::string_view line) { spdlog::log(level_of(level), "{}", line); }

void log_info(std::string_view message) { log_message(spdlog::level::info, message); }

void log_warning(std::string_view message) { log_message(spdlog::level::warn, message); }

void log_error(std::string_view message) { log_message(spdlog::level::err, message); }

}  // namespace tunewright::server
