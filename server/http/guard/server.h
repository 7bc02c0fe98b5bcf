// The HTTP server: an httplib::Server behind a guard. The library writes every answer, passes bodies to handlers and
// streams from them; the guard decides what the library sees.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/http/message.h"

namespace tunewright::server::http {

struct ServerLimits {
    std::size_t max_body = 8 * 1024 * 1024;          ///< bytes of one body; --max-body for the service's port
    std::size_t max_batch_body = 256 * 1024 * 1024;  ///< bytes of one body that is read as it arrives
    std::size_t bodies = 128 * 1024 * 1024;          ///< bytes for all requests that are not answered yet; see Budget
    std::size_t arriving = 6 * 1024 * 1024;          ///< bytes that count for a body that is read as it arrives, at
                                                     ///< most
    std::size_t unsent = 256 * 1024 * 1024;          ///< bytes of answers that clients have not read; see
                                                     ///< UnsentResponses
    std::size_t connections = 2048;          ///< beyond it the longest waiting connection of the network with the most
                                             ///< gives way
    std::size_t of_one_network = 512;        ///< an address, for IPv6 a /64; no such limit for loopback and proxies
    bool behind_proxy = false;               ///< addresses are those of a proxy
    std::chrono::milliseconds idle{60'000};  ///< between two requests
    std::chrono::milliseconds head{10'000};  ///< from the first byte of a request to the end of its head
    std::chrono::milliseconds room{5'000};   ///< for waiting for room in `bodies`
    std::chrono::milliseconds lingering{5'000};
    std::chrono::milliseconds stopping{2'000};  ///< for answers in progress when the server is stopped
    std::chrono::milliseconds farewell{250};    ///< for requests that are arriving at that moment
    std::chrono::milliseconds body_time{30'000};
    std::size_t pace_bytes = 16 * 1024;           ///< a body that is read as it arrives must deliver this many bytes
    std::chrono::milliseconds pace_time{10'000};  ///< in each period of this length in which the server waits for it
    std::chrono::milliseconds writing{60'000};    ///< longer for bodies that need more at 16 KiB/s; for streams the
                                                  ///< limit of each piece
};

/// Answers requests: the router, or a test. All functions may run on many threads at once.
struct Application {
    /// Called with the head only, before any of the body is read; returns a refusal or nothing. May be empty.
    std::function<std::optional<Response>(Request&)> admit;
    /// True if the body is to be read as it arrives (Request::read_body). May be empty.
    std::function<bool(const Request&)> streams;
    /// Bytes that a request needs while it is answered, in addition to its complete body. May be empty: none.
    std::function<std::size_t(const Request&)> weight;
    std::function<Response(Request)> handle;
    /// The answer to input that never becomes a request (malformed, too large, too slow). The Request holds the known
    /// data: if its head was refused, only the address and the fields Origin and X-Request-Id.
    std::function<Response(int status, const std::string& detail, Request& request)> refuse;
};

/// Resources that clients hold at this moment.
struct Occupancy {
    std::size_t connections = 0;
    std::size_t body_bytes = 0;    ///< of requests that are not answered yet
    std::size_t unsent_bytes = 0;  ///< of answers that clients have not read
};

class Server {
public:
    Server(const ServerLimits& limits, Application application);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// Opens the port; 0 lets the system choose. Returns the port. Throws std::runtime_error with a sentence if the
    /// port is taken or forbidden, or the name is unknown. A port on which another process listens is never shared.
    int listen(const std::string& host, int port);

    /// Serves until stop(); then accepts no more connections, answers the requests received so far, and returns when
    /// all answers are sent or `stopping` is over.
    void run();

    /// From any thread.
    void stop();

    Occupancy occupancy() const;

    /// After run(): true if the handlers have ended by then. Otherwise the server must not be destroyed.
    bool idle_within(std::chrono::milliseconds patience);

private:
    class Guard;
    std::unique_ptr<Guard> guard_;
};

}  // namespace tunewright::server::http
