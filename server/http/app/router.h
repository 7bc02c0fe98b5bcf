// The table of routes. 404, 405 with Allow, HEAD and OPTIONS follow from it.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "server/http/message.h"

namespace tunewright::server::http {

/// The values of a pattern's {parts}.
using PathValues = std::map<std::string, std::string, std::less<>>;

struct Call {
    Request request;
    PathValues path;
};

/// Makes the answer. Runs on the request's own thread and may wait.
using Handler = std::function<Response(Call&)>;

/// Data about an answered request, for logs and metrics.
struct Answered {
    std::string method;
    std::string target;
    std::string route;        ///< the pattern, never user text; "" if none matched
    std::string client;       ///< as in Request
    std::string request_id;   ///< "" if the request was refused before it had one
    std::string traceparent;  ///< as in Request
    int status = 0;
    std::size_t bytes = 0;
    std::chrono::microseconds duration{0};
};

/// Headers of every answer: a browser treats it as data that must not be run, framed or stored, unless the answer's own
/// headers allow it.
void add_common_headers(Response& response);

class Router {
public:
    /// Pattern: "/v1/jobs/{id}". For small answers, or constant ones that are compressed already.
    void quick(const std::string& method, const std::string& pattern, Handler handler);
    /// Like quick, with answers that are compressed for clients that accept it.
    void add(const std::string& method, const std::string& pattern, Handler handler);
    /// Like add, for a call whose body is read as it arrives (Request::read_body).
    void streamed(const std::string& method, const std::string& pattern, Handler handler);

    /// Called on GET and HEAD if no pattern matches: files.
    void set_fallback(std::function<std::optional<Response>(const Request&)> fallback) {
        fallback_ = std::move(fallback);
    }
    /// Called first for every request; its return value, if any, is the answer.
    void guard(std::function<std::optional<Response>(Request&)> admit) { admit_ = std::move(admit); }
    /// Called once for each answer, on the thread that gave it.
    void observe(std::function<void(const Answered&)> observer) { observer_ = std::move(observer); }

    // For the Server (Application). The refusal of a request when only its head is known: by the guard, or because no
    // route accepts it.
    std::optional<Response> admit(Request& request) const;
    bool streams(const Request& head) const;
    Response handle(Request request) const;

private:
    struct Route {
        std::string method;
        std::string pattern;
        std::vector<std::string> parts;
        bool compresses = false;
        bool streamed = false;
        Handler handler;
    };

    const Route* find(const Request& request) const;
    Response answer(const Route* route, Call& call) const;
    Response unrouted(const Request& request) const;
    Response observed(const Request& request, const Route* route, std::chrono::steady_clock::time_point start,
                      Response response) const;

    std::vector<Route> routes_;
    std::function<std::optional<Response>(Request&)> admit_;
    std::function<std::optional<Response>(const Request&)> fallback_;
    std::function<void(const Answered&)> observer_;
};

}  // namespace tunewright::server::http
