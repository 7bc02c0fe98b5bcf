// The table of routes: which call goes where. From the table follow 404, 405 with Allow, HEAD and OPTIONS.
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

/// Gives the answer. Runs on the request's own thread and may wait.
using Handler = std::function<Response(Call&)>;

/// What logs and metrics learn about each answered request.
struct Answered {
    std::string method;
    std::string target;
    std::string route;        ///< the pattern, never user text; "" where none matched
    std::string client;       ///< as in Request
    std::string request_id;   ///< "" where the request was refused before it had one
    std::string traceparent;  ///< as in Request
    int status = 0;
    std::size_t bytes = 0;
    std::chrono::microseconds duration{0};
};

/// What every answer of the service carries: whoever reads it in a browser gets it as data, never as something to run,
/// to frame or to remember, unless the answer says so itself.
void add_common_headers(Response& response);

class Router {
public:
    /// Pattern: "/v1/jobs/{id}". For what is small, or compressed once and for all.
    void quick(const std::string& method, const std::string& pattern, Handler handler);
    /// Its answers are compressed for those who take it.
    void add(const std::string& method, const std::string& pattern, Handler handler);
    /// The same for a call whose body is read as it arrives (Request::read_body).
    void streamed(const std::string& method, const std::string& pattern, Handler handler);

    /// Asked on GET and HEAD where no pattern matches: files.
    void set_fallback(std::function<std::optional<Response>(const Request&)> fallback) {
        fallback_ = std::move(fallback);
    }
    /// Asked first about every request; what it returns is the answer.
    void guard(std::function<std::optional<Response>(Request&)> admit) { admit_ = std::move(admit); }
    /// Called once for each answer, on the thread that gave it.
    void observe(std::function<void(const Answered&)> observer) { observer_ = std::move(observer); }

    // For the Server (Application).
    /// The refusal of a request of which only the head is known: by the guard, or as no route takes it.
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
