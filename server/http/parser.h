// The one door to cpp-httplib: it opens the port and reads the head of a request. Everything that touches the network
// after that is ours (server.h), because the library's own loop holds a thread for each open connection.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "server/http/message.h"

namespace tunewright::server::http {

class Parser {
public:
    Parser();
    ~Parser();
    Parser(const Parser&) = delete;
    Parser& operator=(const Parser&) = delete;

    /// Opens a listening, non-blocking socket with a backlog of 1024 and returns it; the parser owns it.
    /// Throws std::runtime_error with a sentence where the port is taken, forbidden or the name unknown.
    /// SO_REUSEADDR alone is set: a port that another process listens on is an error, never shared.
    int listen(const std::string& host, int port);
    /// Closes it: further clients are refused by the system instead of waiting for nobody.
    void stop_listening();

    /// Method, target, segments, query and headers of a head that has passed read_head (its `clean` text).
    /// Nothing where the library cannot read it.
    std::optional<Request> parse(std::string_view head);

private:
    class Front;
    std::unique_ptr<Front> front_;
};

}  // namespace tunewright::server::http
