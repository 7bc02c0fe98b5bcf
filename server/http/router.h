// The table of routes: which call goes where. From the table follow 404, 405 with Allow, HEAD and OPTIONS.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "server/http/message.h"

namespace tunewright::server {
class Executor;
}

namespace tunewright::server::http {

/// The values of a pattern's {parts}.
using PathValues = std::map<std::string, std::string, std::less<>>;

struct Call {
    Request request;
    PathValues path;
};

using SyncHandler = std::function<Response(const Call&)>;
using AsyncHandler = std::function<void(Call, Reply)>;

/// What logs and metrics learn about each answered request.
struct Exchange {
    std::string method;
    std::string target;
    std::string route;       ///< the pattern, never user text; "" where none matched
    std::string client;      ///< as in Request
    std::string request_id;  ///< "" where the request was refused before it had one
    int status = 0;
    std::size_t bytes = 0;
    std::chrono::microseconds duration{0};
};

/// What every answer of the service carries: whoever reads it in a browser gets it as data, never as something to run,
/// to frame or to remember, unless the answer says so itself.
void add_common_headers(Response& response);

class Router {
public:
    explicit Router(Executor& pool) : pool_(pool) {}

    /// Pattern: "/v1/jobs/{id}". The handler answers at once on the event loop: only for what takes microseconds.
    void quick(const std::string& method, const std::string& pattern, SyncHandler handler);
    /// The handler runs on the pool.
    void pooled(const std::string& method, const std::string& pattern, SyncHandler handler);
    /// The handler runs on the pool and replies whenever it can, from any thread.
    void deferred(const std::string& method, const std::string& pattern, AsyncHandler handler);

    /// The same for a call whose body is read as it arrives (Request::source): the handler runs as soon as the head is
    /// there.
    void streamed(const std::string& method, const std::string& pattern, AsyncHandler handler);
    /// True where the head belongs to a route of streamed(): what the server asks before it gathers a body.
    bool streams(const Request& head) const;

    /// Asked on GET and HEAD where no pattern matches: files.
    void otherwise(std::function<std::optional<Response>(const Request&)> fallback) { fallback_ = std::move(fallback); }
    /// Asked first about every request; what it returns is the answer.
    void guard(std::function<std::optional<Response>(Request&)> admit) { admit_ = std::move(admit); }
    /// Called once for each answer, on the thread that gave it.
    void observe(std::function<void(const Exchange&)> observer) { observer_ = std::move(observer); }

    /// A Handler for the Server.
    void handle(Request request, Reply reply) const;

private:
    enum class Lane { quick, pooled };
    struct Route {
        std::string method;
        std::string pattern;
        std::vector<std::string> parts;
        Lane lane = Lane::quick;
        bool streamed = false;
        AsyncHandler handler;
    };

    Route& add(const std::string& method, const std::string& pattern, Lane lane, AsyncHandler handler);
    Reply observed(const Request& request, const std::string& route, bool may_compress, Reply reply) const;
    Response unrouted(const Request& request, const std::vector<std::string>& allowed) const;

    Executor& pool_;
    std::vector<Route> routes_;
    std::function<std::optional<Response>(Request&)> admit_;
    std::function<std::optional<Response>(const Request&)> fallback_;
    std::function<void(const Exchange&)> observer_;
};

}  // namespace tunewright::server::http
