// The port: an httplib::Server behind a guard of ours. The library writes every answer, gives bodies to handlers and
// takes streams from them; the guard decides what it gets to see.
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/http/message.h"

namespace tunewright::server::http {

struct ServerLimits {
    std::size_t max_body = 8 * 1024 * 1024;          ///< bytes of one body
    std::size_t max_batch_body = 256 * 1024 * 1024;  ///< bytes of one body that is read as it arrives
    std::size_t bodies = 128 * 1024 * 1024;          ///< bytes for all requests that are not answered yet; see Budget
    std::size_t arriving = 6 * 1024 * 1024;          ///< what a body that is read as it arrives counts for, at most
    std::size_t unsent = 256 * 1024 * 1024;          ///< bytes of answers that clients have not taken; see Answers
    std::size_t connections = 2048;          ///< beyond it the longest waiting one of whoever has the most gives way
    std::size_t of_one_network = 512;        ///< an address, of IPv6 a /64; loopback and proxies have no such limit
    bool behind_proxy = false;               ///< addresses are a proxy's
    std::chrono::milliseconds idle{60'000};  ///< between two requests
    std::chrono::milliseconds head{10'000};  ///< from the first byte of a request to the end of its head
    std::chrono::milliseconds room{5'000};   ///< for room among `bodies`
    std::chrono::milliseconds lingering{5'000};
    std::chrono::milliseconds stopping{2'000};  ///< for answers under way when the port is asked to stop
    std::chrono::milliseconds farewell{250};    ///< for requests that are on their way to us at that moment
    std::chrono::milliseconds body_time{30'000};
    std::size_t pace_bytes = 16 * 1024;           ///< of a body that is read as it arrives there must come so much
    std::chrono::milliseconds pace_time{10'000};  ///< in each such time in which it is waited for
    std::chrono::milliseconds writing{60'000};    ///< and for long bodies what 16 KiB/s take; of streams each piece
};

/// What answers requests: the router, or a test. All of it may run on many threads at once.
struct Application {
    /// Asked with the head alone, before any of the body is read: a refusal, or nothing. May be empty.
    std::function<std::optional<Response>(Request&)> admit;
    /// True where the body is to be read as it arrives (Request::read_body). May be empty.
    std::function<bool(const Request&)> streams;
    /// Bytes that a request takes while it is answered, beside its body, which is whole. May be empty: none.
    std::function<std::size_t(const Request&)> weight;
    std::function<Response(Request)> handle;
    /// The answer to what never becomes a request (malformed, too large, too slow). Of the request it has what is
    /// known: where its head was refused, no more than the address and the fields Origin and X-Request-Id.
    std::function<Response(int status, const std::string& detail, Request& request)> refuse;
};

/// What clients hold at this moment.
struct Occupancy {
    std::size_t connections = 0;
    std::size_t body_bytes = 0;    ///< of requests that are not answered yet
    std::size_t unsent_bytes = 0;  ///< of answers that clients have not taken
};

class Server {
public:
    Server(const ServerLimits& limits, Application application);
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// Opens the port; 0 lets the system choose. Returns the port. Throws std::runtime_error with a sentence: the port
    /// is taken, forbidden, or the name unknown. A port that another process listens on is never shared.
    int listen(const std::string& host, int port);

    /// Serves until stop(); then takes no more connections, answers what has been sent to it, and returns when all that
    /// is out or `stopping` is over.
    void run();

    /// From any thread.
    void stop();

    Occupancy occupancy() const;

    /// After run(): true where the handlers have ended by then. Without that this must not be destroyed.
    bool idle_within(std::chrono::milliseconds patience);

private:
    class Guard;
    std::unique_ptr<Guard> guard_;
};

}  // namespace tunewright::server::http
