#include "server/log.h"

#include <spdlog/async.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <stdexcept>

#include "server/http/router.h"
#include "server/json_text.h"
#include "server/store/store.h"

namespace tunewright::server {
namespace {

constexpr std::size_t kWaitingLines = 8192;
bool as_json = false;

/// Probes come every few seconds; only the level debug shows them.
spdlog::level::level_enum level_of(const http::Exchange& exchange) {
    const bool probe = exchange.route == "/healthz" || exchange.route == "/readyz" || exchange.route == "/metrics";
    if (exchange.status >= 500) return spdlog::level::warn;
    return probe ? spdlog::level::debug : spdlog::level::info;
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
    spdlog::init_thread_pool(kWaitingLines, 1);
    auto logger =
        std::make_shared<spdlog::async_logger>("", std::make_shared<spdlog::sinks::stderr_sink_mt>(),
                                               spdlog::thread_pool(), spdlog::async_overflow_policy::overrun_oldest);
    logger->set_level(chosen);
    logger->set_pattern(as_json ? R"({"time":"%Y-%m-%dT%H:%M:%S.%eZ","level":"%l",%v})" : "%Y-%m-%dT%H:%M:%S.%eZ %l %v",
                        spdlog::pattern_time_type::utc);
    spdlog::set_default_logger(std::move(logger));
}

void stop_log() { spdlog::shutdown(); }

void log_info(std::string_view message) { log_message(spdlog::level::info, message); }

void log_error(std::string_view message) { log_message(spdlog::level::err, message); }

void log_exchange(const http::Exchange& exchange) {
    const auto level = level_of(exchange);
    if (!spdlog::should_log(level)) return;
    const double ms = static_cast<double>(exchange.duration.count()) * 1e-3;
    const std::string target = json_string(exchange.target);
    if (as_json)
        spdlog::log(
            level,
            R"("event":"request","id":{},"method":{},"target":{},"status":{},"ms":{:.2f},"bytes":{},"client":{})",
            json_string(exchange.request_id), json_string(exchange.method), target, exchange.status, ms, exchange.bytes,
            json_string(exchange.client));
    else
        spdlog::log(level, "request {} {} {} {} {:.2f} ms, {} bytes to {}", exchange.request_id, exchange.method,
                    target, exchange.status, ms, exchange.bytes, exchange.client);
}

void log_job(const JobEnd& job, double seconds) {
    if (as_json)
        spdlog::info(R"("event":"job","id":"{}","status":"{}","ms":{:.2f},"attempts":{})", job.id,
                     to_string(job.status), seconds * 1e3, job.attempts);
    else
        spdlog::info("job {} {} after {:.2f} ms, attempt {}", job.id, to_string(job.status), seconds * 1e3,
                     job.attempts);
}

}  // namespace tunewright::server
