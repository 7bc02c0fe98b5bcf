#include "server/http/app/answer_log.h"

#include <fmt/format.h>

#include <algorithm>

#include "server/json_text.h"
#include "server/log.h"

namespace tunewright::server::http {
namespace {

/// Probes come every few seconds; only the level debug shows them.
LogLevel level_of(const Answered& answered) {
    const bool probe = answered.route == "/healthz" || answered.route == "/readyz" || answered.route == "/metrics";
    if (answered.status >= 500) return LogLevel::warning;
    return probe ? LogLevel::debug : LogLevel::info;
}

bool is_word(std::string_view text) {
    return !text.empty() && std::ranges::all_of(text, [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
    });
}

/// The request's target in quotes, with the names of its parameters only: a value may be a secret, such as the address
/// for a batch's notification, even if the name is spelled in another way.
std::string shown_target(std::string_view target) {
    const std::size_t mark = std::min(target.find('?'), target.size());
    std::string shown(target.substr(0, mark));
    for (std::size_t at = mark; at < target.size();) {
        const std::size_t end = std::min(target.find('&', at + 1), target.size());
        const std::string_view parameter = target.substr(at + 1, end - at - 1);
        const std::string_view name = parameter.substr(0, std::min(parameter.find('='), parameter.size()));
        shown += at == mark ? '?' : '&';
        // A parameter without a value may itself be a secret.
        if (name.size() < parameter.size() && is_word(name)) shown.append(name).append("=");
        if (!parameter.empty()) shown += "...";
        at = end;
    }
    return json_string(shown);
}

}  // namespace

void log_answer(const Answered& answered) {
    const auto level = level_of(answered);
    if (!logs(level)) return;
    const double ms = static_cast<double>(answered.duration.count()) * 1e-3;
    const std::string target = shown_target(answered.target);
    if (log_is_json())
        log_line(
            level,
            fmt::format(
                R"("event":"request","id":{},"method":{},"target":{},"status":{},"ms":{:.2f},"bytes":{},"client":{},"traceparent":"{}")",
                json_string(answered.request_id), json_string(answered.method), target, answered.status, ms,
                answered.bytes, json_string(answered.client), answered.traceparent));
    else
        log_line(level, fmt::format("request {} {} {} {} {:.2f} ms, {} bytes to {}", answered.request_id,
                                    answered.method, target, answered.status, ms, answered.bytes, answered.client));
}

}  // namespace tunewright::server::http
