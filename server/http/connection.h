// One client's connection: bytes in, bytes out, never blocking. Belongs to the thread of the event loop alone.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "server/http/body/incoming_body.h"
#include "server/http/head.h"
#include "server/http/message.h"
#include "server/http/outgoing.h"
#include "server/http/pace.h"

namespace tunewright::server::http {

using SteadyTime = std::chrono::steady_clock::time_point;

class Connection {
public:
    /// reading: waits for a whole request. handling: a handler has it, and may be reading its body. writing: the answer
    /// is on its way. lingering: the answer is out, what the client still sends is read and dropped so that the answer
    /// survives.
    enum class State { reading, handling, writing, lingering };

    Connection(int fd, std::string remote_addr) : fd_(fd), remote_addr_(std::move(remote_addr)) {}
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// Reads what is there, until there is news for frame(). done: a head or a whole request may be there; again:
    /// nothing more for now; gone: the client has closed or failed.
    Io receive();

    /// Looks for a head at the front of the buffer; the state of the result says what was found.
    const Head& frame();
    /// What is to become of a complete head: its request, and whether its body is gathered first.
    void admit(Request request, bool streamed, std::size_t body_limit);
    bool admitted() const { return request_.has_value(); }
    void refuse(int status, std::string detail);
    /// The request, with its body unless that is streamed, can be handled.
    bool request_ready() const;
    /// Takes the request, and the bytes that were gathered for it, out of the connection.
    Request take_request();

    /// A piece of the streamed body, from what is here and what the socket has. done: `piece` has something, or the
    /// decoder has ended; again and gone as with receive().
    Io receive_body(std::string& piece);

    void start_answer(Response response, bool keep_alive, const std::function<void()>& wake);
    /// Sends as much as the socket takes.
    Io send() { return out.send(fd_); }
    /// Interim answer 100, once, where it was asked for; small enough to be sent or lost at once.
    void send_continue();
    /// No more answers; the client learns that, and what it still sends is dropped by discard().
    void start_lingering();
    Io discard();

    int fd() const { return fd_; }
    const std::string& remote_addr() const { return remote_addr_; }
    std::size_t buffered() const { return in_.size(); }
    bool idle() const { return state == State::reading && in_.empty(); }
    bool fresh() const { return ticket == 0; }
    bool keeps_alive() const { return keep_alive_; }
    bool streamed() const { return streamed_; }

    State state = State::reading;
    std::uint64_t ticket = 0;  ///< of the request under way; an answer to another one is too late
    SteadyTime deadline{};     ///< when the present state has lasted too long
    SteadyTime since{};        ///< when the present state began
    bool readable = false;     ///< the socket had more when we stopped reading
    bool peer_closed = false;  ///< the client has sent all that it will send

    Outgoing out;
    std::shared_ptr<IncomingBody> incoming;  ///< of a streamed request under way
    Pace pace;                               ///< of that body

private:
    int fd_;
    std::string remote_addr_;
    std::string in_;
    std::size_t scanned_ = 0;  ///< the end of the head is not before this offset
    Head head_;
    std::optional<Request> request_;
    bool streamed_ = false;
    bool wants_continue_ = false;
    bool chunks_ = true;
    bool keep_alive_ = true;
    std::size_t linger_left_ = 0;
};

}  // namespace tunewright::server::http
