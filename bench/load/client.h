// A small HTTP/1.1 client for measurements: many kept-alive connections on one epoll and one thread, so that the client
// takes as little of the machine as it can from the server on the same host. It reads what Tunewright answers
// (Content-Length, or chunks) and is no general client.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tunewright::load {

using Clock = std::chrono::steady_clock;

struct Answer {
    int status = 0;  ///< 0: the connection was lost before the answer was whole
    std::string head;
    std::string body;
    double seconds = 0;  ///< from the request's sending to its last byte

    /// Value of a header field, "" where it is missing. `name` in lower case.
    std::string header(std::string_view name) const;
};

/// The bytes of a request, ready to be sent; `fields` are whole lines, each with its CR LF.
std::string get(std::string_view target, std::string_view fields = "");
std::string post(std::string_view target, std::string_view body, std::string_view fields = "");
/// What every request carries from now on, such as "Authorization: Bearer ...\r\n".
void send_always(std::string fields);

class Client {
public:
    using Id = std::uint64_t;
    using Then = std::function<void(Id connection, Answer answer)>;

    /// Loopback, IPv4.
    explicit Client(int port);
    ~Client();
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    /// A new connection. Throws std::runtime_error where it cannot be opened.
    Id open();
    /// One request at a time on a connection; `then` runs inside run_until() and may send the next one. A connection
    /// that was lost is opened again by itself.
    void send(Id connection, std::string request, Then then);
    /// Bytes without any expectation; false where the connection is gone.
    bool send_raw(Id connection, std::string_view bytes);
    /// True once the head of the present answer is there: a stream is open.
    bool head_received(Id connection) const;
    bool is_open(Id connection) const;
    /// Bytes received on a connection so far.
    std::uint64_t received(Id connection) const;
    void close(Id connection);

    /// Serves the connections until `done` (asked after each round of events) or until the time is over.
    void run_until(const std::function<bool()>& done, Clock::time_point end);
    /// Sends one request on a connection of its own and waits for the answer.
    Answer call(const std::string& request, std::chrono::seconds patience = std::chrono::seconds(90));

private:
    struct Connection;
    void connect(Connection& connection);
    void flush(Connection& connection);
    void receive(Connection& connection);
    bool take_answer(Connection& connection);
    void lose(Connection& connection);
    void finish(Connection& connection, Answer answer);

    int port_;
    int epoll_;
    Id next_ = 1;
    std::map<Id, std::unique_ptr<Connection>> connections_;
    std::vector<char> buffer_;
};

}  // namespace tunewright::load
