#include "server/log.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

#include "server/http/app/router.h"
#include "server/jobs/running/result_outbox.h"
#include "server/json_text.h"
#include "server/log_sink.h"

namespace tunewright::server {
namespace {

constexpr std::size_t kWaitingLines = 8192;
bool as_json = false;
std::shared_ptr<GatheringSink> sink;

/// Probes come every few seconds; only the level debug shows them.
spdlog::level::level_enum level_of(const http::Answered& answered) {
    const bool probe = answered.route == "/healthz" || answered.route == "/readyz" || answered.route == "/metrics";
    if (answered.status >= 500) return spdlog::level::warn;
    return probe ? spdlog::level::debug : spdlog::level::info;
}

bool is_word(std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
}

/// What was asked for, in quotes, with the names of the parameters alone: a value may be a secret, such as the address
/// that a batch tells, also where the name before it is spelt in another way.
std::string shown_target(std::string_view target) {
    const std::size_t mark = std::min(target.find('?'), target.size());
    std::string shown(target.substr(0, mark));
    for (std::size_t at = mark; at < target.size();) {
        const std::size_t end = std::min(target.find('&', at + 1), target.size());
        const std::string_view parameter = target.substr(at + 1, end - at - 1);
        const std::string_view name = parameter.substr(0, std::min(parameter.find('='), parameter.size()));
        shown += at == mark ? '?' : '&';
        // Without a value, it may be one.
        if (name.size() < parameter.size() && is_word(name)) shown.append(name).append("=");
        if (!parameter.empty()) shown += "...";
        at = end;
    }
    return json_string(shown);
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

void stop_log() {
    spdlog::shutdown();
    sink.reset();
}

std::size_t dropped_log_lines() { return sink ? sink->dropped() : 0; }

void log_info(std::string_view message) { log_message(spdlog::level::info, message); }

void log_warning(std::string_view message) { log_message(spdlog::level::warn, message); }

void log_error(std::string_view message) { log_message(spdlog::level::err, message); }

void log_answer(const http::Answered& answered) {
    const auto level = level_of(answered);
    if (!spdlog::should_log(level)) return;
    const double ms = static_cast<double>(answered.duration.count()) * 1e-3;
    const std::string target = shown_target(answered.target);
    if (as_json)
        spdlog::log(
            level,
            R"("event":"request","id":{},"method":{},"target":{},"status":{},"ms":{:.2f},"bytes":{},"client":{},"traceparent":"{}")",
            json_string(answered.request_id), json_string(answered.method), target, answered.status, ms, answered.bytes,
            json_string(answered.client), answered.traceparent);
    else
        spdlog::log(level, "request {} {} {} {} {:.2f} ms, {} bytes to {}", answered.request_id, answered.method,
                    target, answered.status, ms, answered.bytes, answered.client);
}

void log_job(const Ended& ended) {
    const JobEnd& end = ended.end;
    const JobRecord& job = ended.held->job;
    const double ms = ended.seconds * 1e3;
    if (as_json)
        spdlog::info(
            R"("event":"job","id":"{}","status":"{}","ms":{:.2f},"attempts":{},"method":{},"owner":{},"batch":"{}",)"
            R"("request_id":{},"traceparent":"{}")",
            end.id, to_string(end.status), ms, end.attempts, json_string(ended.method), json_string(job.owner),
            job.batch, json_string(job.request_id), job.traceparent);
    else
        spdlog::info("job {} {} after {:.2f} ms, attempt {}{}{}{}", end.id, to_string(end.status), ms, end.attempts,
                     job.owner.empty() ? "" : ", of " + job.owner, job.batch.empty() ? "" : ", batch " + job.batch,
                     job.request_id.empty() ? "" : ", request " + job.request_id);
}

}  // namespace tunewright::server
