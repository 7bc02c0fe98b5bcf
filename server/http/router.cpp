#include "server/http/router.h"

#include <algorithm>

#include "server/executor.h"
#include "server/http/body/compression.h"
#include "server/http/problems.h"
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

/// Runs a handler; what it throws becomes a 500 that says nothing about our insides.
void run_guarded(const AsyncHandler& handler, Call call, const Reply& reply) {
    const std::string target = call.request.method + " " + std::string(call.request.path());
    try {
        handler(std::move(call), reply);
    } catch (const std::exception& fault) {
        log_error(target + " failed: " + fault.what());
        reply(problem_response(500, "The service failed to handle this request; its log says more."));
    }
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

void Router::quick(const std::string& method, const std::string& pattern, SyncHandler handler) {
    add(method, pattern, Lane::quick,
        [handler = std::move(handler)](const Call& call, const Reply& reply) { reply(handler(call)); });
}

void Router::pooled(const std::string& method, const std::string& pattern, SyncHandler handler) {
    add(method, pattern, Lane::pooled,
        [handler = std::move(handler)](const Call& call, const Reply& reply) { reply(handler(call)); });
}

void Router::deferred(const std::string& method, const std::string& pattern, AsyncHandler handler) {
    add(method, pattern, Lane::pooled, std::move(handler));
}

void Router::streamed(const std::string& method, const std::string& pattern, AsyncHandler handler) {
    add(method, pattern, Lane::pooled, std::move(handler)).streamed = true;
}

bool Router::streams(const Request& head) const {
    return std::ranges::any_of(routes_, [&](const Route& route) {
        return route.streamed && serves(route.method, head.method) && matches(route.parts, head.segments);
    });
}

Router::Route& Router::add(const std::string& method, const std::string& pattern, Lane lane, AsyncHandler handler) {
    routes_.push_back({method, pattern, split_pattern(pattern), lane, false, std::move(handler)});
    return routes_.back();
}

void Router::handle(Request request, Reply reply) const {
    if (admit_) {
        if (std::optional<Response> refusal = admit_(request))
            return observed(request, "", false, std::move(reply))(*std::move(refusal));
    }
    std::vector<std::string> allowed;
    for (const Route& route : routes_) {
        if (!matches(route.parts, request.segments)) continue;
        if (!serves(route.method, request.method)) {
            allowed.push_back(route.method);
            continue;
        }
        Reply answer = observed(request, route.pattern, route.lane == Lane::pooled, std::move(reply));
        Call call{std::move(request), {}};
        call.path = values_of(route.parts, call.request.segments);
        if (route.lane == Lane::quick) return run_guarded(route.handler, std::move(call), answer);
        pool_.post([handler = &route.handler, call = std::move(call), answer = std::move(answer)]() mutable {
            run_guarded(*handler, std::move(call), answer);
        });
        return;
    }
    const Reply answer = observed(request, "", false, std::move(reply));
    answer(unrouted(request, allowed));
}

Response Router::unrouted(const Request& request, const std::vector<std::string>& allowed) const {
    std::vector<std::string> methods = allowed;
    if (methods.empty() && fallback_) {
        std::optional<Response> file = fallback_(request);
        if (file && serves("GET", request.method)) return *std::move(file);
        if (file) methods.emplace_back("GET");
    }
    if (methods.empty() && request.target != "*")
        return problem_response(
            404, "There is nothing at " + std::string(request.path()) + "; /openapi.json lists what there is.");
    if (request.method == "OPTIONS") {
        Response response;
        response.status = 204;
        return response.set("Allow", allow_text(methods));
    }
    const std::string allow = allow_text(methods);
    Response response = problem_response(
        405, request.method + " is not possible at " + std::string(request.path()) + "; use one of " + allow + ".");
    return response.set("Allow", allow);
}

/// `may_compress`: the answer is made on a thread that has the time.
Reply Router::observed(const Request& request, const std::string& route, bool may_compress, Reply reply) const {
    Exchange exchange{request.method, request.target, route, request.client, request.request_id, 0, 0, {}};
    return [this, exchange = std::move(exchange), reply = std::move(reply), headers = request.answer_headers,
            takes_gzip = may_compress && accepts_gzip(request), may_compress,
            start = std::chrono::steady_clock::now()](Response response) mutable {
        if (may_compress) compress(response, takes_gzip);
        for (const auto& [name, value] : headers) response.set(name, value);
        add_common_headers(response);
        if (observer_) {
            exchange.status = response.status;
            exchange.bytes = response.body.size();
            exchange.duration =
                std::chrono::duration_cast<std::chrono::microseconds>(std::chrono::steady_clock::now() - start);
            observer_(exchange);
        }
        reply(std::move(response));
    };
}

}  // namespace tunewright::server::http
