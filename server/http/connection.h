// One client's connection: bytes in, bytes out, never blocking. Belongs to the thread of the event loop alone.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

#include "server/http/head.h"
#include "server/http/message.h"

namespace tunewright::server::http {

using SteadyTime = std::chrono::steady_clock::time_point;

class Connection {
public:
    /// reading: waits for a whole request. handling: a handler has it. writing: the answer is on its way.
    /// lingering: the answer is out, what the client still sends is read and dropped so that the answer survives.
    enum class State { reading, handling, writing, lingering };
    enum class Io { done, again, gone };

    Connection(int fd, std::string remote_addr) : fd_(fd), remote_addr_(std::move(remote_addr)) {}
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// Reads what is there into the buffer, at most what the request under way needs. done: a whole request, or
    /// something to refuse, may be there; again: nothing more for now; gone: the client has closed or failed.
    Io receive(std::size_t body_limit);

    /// Looks for a whole request at the front of the buffer; the state of the result says what was found.
    const Head& frame(std::size_t body_limit);
    bool request_complete() const;

    /// Takes the body of the complete request out of the buffer and forgets the request's bytes.
    std::string take_body();

    void start_answer(Response response, bool keep_alive);
    /// Sends as much as the socket takes.
    Io send();
    /// Interim answer 100; small enough to be sent or lost at once.
    void send_continue();
    /// No more answers; the client learns that, and what it still sends is dropped by discard().
    void start_lingering(std::size_t allowance);
    Io discard();

    int fd() const { return fd_; }
    const std::string& remote_addr() const { return remote_addr_; }
    std::size_t buffered() const { return in_.size(); }
    bool idle() const { return state == State::reading && in_.empty(); }
    bool keeps_alive() const { return keep_alive_; }

    State state = State::reading;
    std::uint64_t ticket = 0;  ///< of the request under way; an answer to another one is too late
    SteadyTime deadline{};     ///< when the present state has lasted too long
    SteadyTime since{};        ///< when the present state began
    bool readable = false;     ///< the socket had more when we stopped reading
    bool peer_closed = false;  ///< the client has sent all that it will send

private:
    int fd_;
    std::string remote_addr_;
    std::string in_;
    std::size_t scanned_ = 0;  ///< the end of the head is not before this offset
    Head head_;
    bool continued_ = false;
    std::string out_head_;
    std::string out_body_;
    std::size_t sent_ = 0;
    bool keep_alive_ = true;
    std::size_t linger_left_ = 0;
};

}  // namespace tunewright::server::http
