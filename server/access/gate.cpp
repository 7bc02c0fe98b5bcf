#include "server/access/gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "server/http/app/problems.h"

namespace tunewright::server {
namespace {

using http::problem_response;
using http::Request;
using http::Response;

constexpr const char* kExposed = "Location, ETag, Retry-After, X-Request-Id, Server-Timing, Preference-Applied";

/// Health checks come from monitoring; they are neither counted nor asked for a key.
bool is_probe(const Request& request) { return request.path() == "/healthz" || request.path() == "/readyz"; }

/// The page, its description and probes contain nothing about jobs.
bool needs_key(const Request& request) {
    if (request.segments.empty()) return false;
    const std::string& first = request.segments.front();
    return first == "v1" || first == "mcp" || first == "metrics";
}

bool changes(const Request& request) {
    return request.method != "GET" && request.method != "HEAD" && request.method != "OPTIONS";
}

std::string_view bearer(const Request& request) {
    std::string_view text = request.header("Authorization");
    constexpr std::string_view scheme = "bearer ";
    if (text.size() <= scheme.size() || !std::ranges::equal(text.substr(0, scheme.size()), scheme, [](char a, char b) {
            return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b;
        }))
        return {};
    text.remove_prefix(scheme.size());
    const std::size_t first = text.find_first_not_of(' ');
    return first == std::string_view::npos ? std::string_view{} : text.substr(first);
}

/// Some proxies add the port, which differs between calls, and write an IPv6 address in brackets.
std::string_view without_port(std::string_view address) {
    if (address.starts_with('[')) return address.substr(1, address.find(']') - 1);
    const std::size_t colon = address.find(':');
    return colon == address.rfind(':') ? address.substr(0, colon) : address;
}

/// The address that the nearest proxy wrote: the last one of the field.
std::string_view forwarded(const Request& request) {
    std::string_view last;
    const auto [first, end] = request.headers.equal_range("X-Forwarded-For");
    for (auto it = first; it != end; ++it) last = it->second;
    last = last.substr(last.find_last_of(',') + 1);
    while (!last.empty() && last.front() == ' ') last.remove_prefix(1);
    while (!last.empty() && last.back() == ' ') last.remove_suffix(1);
    last = without_port(last);
    constexpr std::size_t longest = 45;
    return last.size() <= longest ? last : std::string_view{};
}

/// 00-TRACE-SPAN-FLAGS (W3C Trace Context, 2021), neither id all zeros. It is written to logs, so no other form is
/// accepted.
bool is_traceparent(std::string_view text) {
    const auto hex = [&](std::size_t from, std::size_t count) {
        return std::ranges::all_of(text.substr(from, count),
                                   [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); });
    };
    const auto zero = [&](std::size_t from, std::size_t count) {
        return text.substr(from, count).find_first_not_of('0') == std::string_view::npos;
    };
    return text.size() == 55 && text.starts_with("00-") && text[35] == '-' && text[52] == '-' && hex(3, 32) &&
           hex(36, 16) && hex(53, 2) && !zero(3, 32) && !zero(36, 16);
}

Response preflight() {
    Response response;
    response.status = 204;
    return response.set("Access-Control-Allow-Methods", "GET, HEAD, POST, DELETE")
        .set("Access-Control-Allow-Headers",
             "Authorization, Content-Type, Idempotency-Key, If-Match, If-None-Match, Last-Event-ID, "
             "MCP-Protocol-Version, Prefer, "
             "Traceparent, "
             "X-Request-Id")
        .set("Access-Control-Max-Age", "600");
}

}  // namespace

Gate::Gate(const GateSettings& settings) : settings_(settings), sites_(settings.sites) {
    if (!settings_.keys_file.empty()) keys_ = std::make_unique<KeyRing>(settings_.keys_file);
    if (settings_.rate > 0) rate_ = std::make_unique<RateLimit>(settings_.rate, settings_.burst);
    process_ = new_key().substr(3, 8);
}

std::optional<Response> Gate::admit(Request& request) {
    name(request);
    if (auto refusal = check_host(request)) return refusal;
    if (auto refusal = check_site(request)) return refusal;
    auto no_key = check_key(request);
    // A client that tries keys is limited too, by its address.
    if (auto refusal = check_rate(request)) return refusal;
    return no_key;
}

void Gate::name_refused(Request& request) {
    name(request);
    allow_site(request);
}

void Gate::name(Request& request) {
    const std::string_view given = request.header("X-Request-Id");
    // An id from outside must be as plain as a key's name: it is copied into headers and logs.
    if (is_key_name(given)) {
        request.request_id = given;
    } else {
        request.request_id = fmt::format("{}-{:08x}", process_, ++count_);
    }
    request.answer_headers.emplace_back("X-Request-Id", request.request_id);
    if (const std::string_view trace = request.header("traceparent"); is_traceparent(trace))
        request.traceparent = trace;
    const std::string_view client = settings_.behind_proxy ? forwarded(request) : std::string_view{};
    request.client = client.empty() ? request.remote_addr : std::string(client);
}

/// A page on a name that was rebound to this machine could otherwise use the service on behalf of its visitor. It has
/// no key, so if keys are required every name is accepted, unless names are configured.
std::optional<Response> Gate::check_host(const Request& request) const {
    const bool any = keys_ && settings_.sites.allowed_hosts.empty();
    if (any || is_probe(request) || !request.has_header("Host") || sites_.serves(request.header("Host")))
        return std::nullopt;
    return problem_response(421,
                            "This service does not answer to the name in the field Host. Call it by its address, or "
                            "start it with --allowed-host and that name.");
}

/// True if the call comes from a page of another site that may read the answers; they then carry the CORS headers.
bool Gate::allow_site(Request& request) const {
    if (!settings_.sites.cors_origins.empty()) request.answer_headers.emplace_back("Vary", "Origin");
    const std::string_view origin = request.header("Origin");
    if (origin.empty() || !sites_.is_allowed_site(origin)) return false;
    request.answer_headers.emplace_back("Access-Control-Allow-Origin", origin);
    request.answer_headers.emplace_back("Access-Control-Expose-Headers", kExposed);
    return true;
}

std::optional<Response> Gate::check_site(Request& request) const {
    const std::string_view origin = request.header("Origin");
    if (allow_site(request)) {
        if (request.method == "OPTIONS" && request.has_header("Access-Control-Request-Method")) return preflight();
        return std::nullopt;
    }
    const bool foreign = !origin.empty() && !sites_.may_call(origin, request.header("Host"));
    // A browser that sends no origin states in this field that another site's page made the call. A user who follows a
    // link to the page comes from there too.
    const std::string_view site = request.header("Sec-Fetch-Site");
    const bool follows_link = !changes(request) && request.header("Sec-Fetch-Mode") == "navigate";
    const bool crossing = (site == "cross-site" || site == "same-site") && !follows_link;
    if (!foreign && !crossing) return std::nullopt;
    api::Problem problem =
        http::problem(403, "Pages of other sites may not call this service. --cors-origin allows a site.");
    problem.type = "cross-site-request";
    return problem_response(problem);
}

std::optional<Response> Gate::check_key(Request& request) {
    request.admin = !keys_ && settings_.own_machine;
    if (!keys_) return std::nullopt;
    request.owner = "";
    if (!needs_key(request)) return std::nullopt;
    const std::string_view key = bearer(request);
    std::optional<KeyHolder> holder = key.empty() ? std::nullopt : keys_->holder_of(key);
    if (holder) {
        request.client = "key:" + holder->name;
        request.owner = std::move(holder->name);
        request.admin = holder->admin;
        request.admitted = [this, given = std::string(key)] { return keys_->holder_of(given).has_value(); };
        return std::nullopt;
    }
    Response response =
        problem_response(401, key.empty() ? "This service asks for a key: send it as Authorization: Bearer KEY."
                                          : "The key is not known here. Ask the operator of the service for one.");
    return response.set("WWW-Authenticate", key.empty() ? R"(Bearer realm="tunewright")"
                                                        : R"(Bearer realm="tunewright", error="invalid_token")");
}

std::optional<Response> Gate::check_rate(const Request& request) {
    if (!rate_ || is_probe(request)) return std::nullopt;
    const auto wait = rate_->refuse(request.client, std::chrono::steady_clock::now());
    if (!wait) return std::nullopt;
    api::Problem problem = http::problem(429, "This client calls too often. Wait as long as Retry-After says.");
    problem.type = "rate-limit";
    return http::problem_response(problem, std::chrono::seconds(static_cast<long>(std::ceil(wait->count()))));
}

}  // namespace tunewright::server
