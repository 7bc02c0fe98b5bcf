// One request in the library: the head that the guard has read becomes a Request, and the handler's answer becomes the
// library's response.
#pragma once

#include <httplib.h>

#include "server/http/guard/budget.h"
#include "server/http/guard/connection.h"
#include "server/http/guard/server.h"
#include "server/http/guard/unsent_responses.h"

namespace tunewright::server::http {

class Exchange {
public:
    Exchange(Connection& connection, const Head& head, const Application& application, const ServerLimits& limits,
             Budget& bodies, UnsentResponses& answers, const std::atomic<bool>& stopping);

    /// Gives the connection to `process`, the library's process_request with the hooks below. True if another request
    /// may follow.
    template <class Process>
    bool run(const Process& process) {
        current() = this;
        const bool whole = process(connection_);
        return connection_.flush() && whole && keep_;
    }

    // The library's hooks, in their order. Each is called on the thread of its exchange.
    static void on_head(httplib::Request& raw) { current()->take(raw); }
    static httplib::Server::HandlerResponse before_body(httplib::Response& out) { return current()->begin(out); }
    static void with_body(httplib::Response& out, const httplib::ContentReader& body) { current()->answer(out, body); }
    static void before_headers(httplib::Response& out) { current()->finish(out); }

private:
    // The library passes no user data through; an exchange stays on one thread from start to end.
    static Exchange*& current();

    void take(httplib::Request& raw);
    httplib::Server::HandlerResponse begin(httplib::Response& out);
    std::optional<Response> refuse_early();
    void answer(httplib::Response& out, const httplib::ContentReader& body);
    bool count(std::size_t bytes);
    void finish(httplib::Response& out);
    Response handled();
    Response refused(int status, const std::string& detail);
    void give(Response response, httplib::Response& out);
    void give_stream(BodyProducer producer, const std::string& type, httplib::Response& out);

    Connection& connection_;
    Head head_;
    const Application& application_;
    const ServerLimits& limits_;
    Budget& bodies_;
    UnsentResponses& answers_;
    const std::atomic<bool>& stopping_;
    Request request_;
    std::shared_ptr<Budget::Reservation> share_;
    std::size_t come_ = 0;               ///< bytes of the body, as far as they are held
    UnsentResponses::Reservation held_;  ///< the body of the answer; the library has it until the end of the exchange
    bool taken_ = false;                 ///< the library accepted the head
    bool streamed_ = false;
    bool keep_;
};

}  // namespace tunewright::server::http
