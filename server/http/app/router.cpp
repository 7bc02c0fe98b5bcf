#include "server/http/app/router.h"

#include <algorithm>

#include "server/http/app/compression.h"
#include "server/http/app/problems.h"
#include "server/log.h"

namespace tunewright::server::http {
namespace {

std::vector<std::string> split_pattern(std::string_view pattern) {
    std::vector<std::string> parts;
    while (!pattern.empty() && pattern != "/") {
        pattern.remove_prefix(1);
        const std::size_t slash = pattern.find('/');
        parts.emplace_back(pattern.substr(0, slash));
        pattern = slash == std::string_view::npos ? std::string_view{} : pattern.substr(slash);
    }
    return parts;
}

bool is_value(const std::string& part) { return part.front() == '{'; }

bool matches(const std::vector<std::string>& parts, const std::vector<std::string>& segments) {
    return std::ranges::equal(parts, segments, [](const std::string& part, const std::string& segment) {
        return is_value(part) ? !segment.empty() : part == segment;
    });
}

PathValues values_of(const std::vector<std::string>& parts, const std::vector<std::string>& segments) {
    PathValues values;
    for (std::size_t i = 0; i < parts.size(); i++)
        if (is_value(parts[i])) values.emplace(parts[i].substr(1, parts[i].size() - 2), segments[i]);
    return values;
}

bool serves(const std::string& method, const std::string& asked) {
    return method == asked || (method == "GET" && asked == "HEAD");
}

std::string allow_text(std::vector<std::string> methods) {
    if (std::ranges::count(methods, "GET") > 0) methods.emplace_back("HEAD");
    methods.emplace_back("OPTIONS");
    std::string text;
    for (const std::string& method : methods) text.append(text.empty() ? "" : ", ").append(method);
    return text;
}

}  // namespace

void add_common_headers(Response& response) {
    const auto has = [&](std::string_view name) {
        return std::ranges::any_of(response.headers, [&](const auto& header) { return header.first == name; });
    };
    response.set("X-Content-Type-Options", "nosniff").set("Referrer-Policy", "no-referrer");
    if (!has("Cache-Control")) response.set("Cache-Control", "no-store");
    if (!has("Content-Security-Policy"))
        response.set("Content-Security-Policy", "default-src 'none'; frame-ancestors 'none'");
}

void Router::quick(const std::string& method, const std::string& pattern, Handler handler) {
    routes_.push_back({method, pattern, split_pattern(pattern), false, false, std::move(handler)});
}

void Router::add(const std::string& method, const std::string& pattern, Handler handler) {
    routes_.push_back({method, pattern, split_pattern(pattern), true, false, std::move(handler)});
}

void Router::streamed(const std::string& method, const std::string& pattern, Handler handler) {
    routes_.push_back({method, pattern, split_pattern(pattern), true, true, std::move(handler)});
}

const Router::Route* Router::find(const Request& request) const {
    const auto found = std::ranges::find_if(routes_, [&](const Route& route) {
        return serves(route.method, request.method) && matches(route.parts, request.segments);
    });
    return found == routes_.end() ? nullptr : &*found;
}

bool Router::streams(const Request& head) const {
    const Route* route = find(head);
    return route != nullptr && route->streamed;
}

std::optional<Response> Router::admit(Request& request) const {
    const auto start = std::chrono::steady_clock::now();
    std::optional<Response> refusal = admit_ ? admit_(request) : std::nullopt;
    if (!refusal && request.method != "GET" && request.method != "HEAD" && find(request) == nullptr)
        refusal = unrouted(request);
    if (!refusal) return std::nullopt;
    return observed(request, nullptr, start, *std::move(refusal));
}

Response Router::handle(Request request) const {
    const auto start = std::chrono::steady_clock::now();
    const Route* route = find(request);
    Call call{std::move(request), {}};
    if (route != nullptr) call.path = values_of(route->parts, call.request.segments);
    return observed(call.request, route, start, answer(route, call));
}

/// An exception of a handler becomes a 500 that reveals nothing about the program.
Response Router::answer(const Route* route, Call& call) const {
    try {
        return route != nullptr ? route->handler(call) : unrouted(call.request);
    } catch (const std::exception& fault) {
        log_error(call.request.method + " " + std::string(call.request.path()) + " failed: " + fault.what());
        return problem_response(500, "The service failed to handle this request; its log says more.");
    }
}

Response Router::unrouted(const Request& request) const {
    std::vector<std::string> methods;
    for (const Route& route : routes_)
        if (matches(route.parts, request.segments)) methods.push_back(route.method);
    if (methods.empty() && fallback_) {
        std::optional<Response> file = fallback_(request);
        if (file && serves("GET", request.method)) return *std::move(file);
        if (file) methods.emplace_back("GET");
    }
    if (methods.empty() && request.target != "*")
        return problem_response(
            404, "There is nothing at " + std::string(request.path()) + "; /openapi.json lists all calls.");
    const std::string allow = allow_text(methods);
    Response response;
    response.status = 204;
    if (request.method != "OPTIONS")
        response = problem_response(
            405, request.method + " is not possible at " + std::string(request.path()) + "; use one of " + allow + ".");
    return response.set("Allow", allow);
}

/// The answer with the common headers, after it was reported to logs and metrics.
Response Router::observed(const Request& request, const Route* route, std::chrono::steady_clock::time_point start,
                          Response response) const {
    if (route != nullptr && route->compresses) compress(response, accepts_gzip(request));
    for (const auto& [name, value] : request.answer_headers) response.set(name, value);
    add_common_headers(response);
    if (!observer_) return response;
    using std::chrono::microseconds;
    observer_({request.method, request.target, route == nullptr ? "" : route->pattern, request.client,
               request.request_id, request.traceparent, response.status, response.body.size(),
               std::chrono::duration_cast<microseconds>(std::chrono::steady_clock::now() - start)});
    return response;
}

}  // namespace tunewright::server::http
