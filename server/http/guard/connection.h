// One client's connection, as the HTTP library reads and writes it: the head that the guard has checked, then the body
// without its chunks; never a byte of the next request. Every wait has a timeout.
#pragma once

#include <httplib.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "server/http/guard/head.h"
#include "server/http/guard/server.h"

namespace tunewright::server::http {

class Connection : public httplib::Stream {
public:
    using Clock = std::chrono::steady_clock;

    Connection(int fd, std::string address, std::string network, const ServerLimits& limits);
    ~Connection() override;
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    /// Waits for the next head, which may be a refusal; empty if the client has disconnected or sends none.
    std::optional<Head> next_head();

    /// From now on the library reads this text, and then the body that `head` announces.
    void start(const Head& head, std::string_view text);
    /// The body is either gathered within `body_time`, or read as it arrives, at a minimum pace.
    void expect_body(bool as_it_arrives);
    /// The body cannot be accepted: 503 with this sentence. Always false.
    bool refuse_body(std::string detail) { return fail(503, std::move(detail)); }
    /// Drops the received part of the body. False: some is still on its way.
    bool drop_body();
    bool body_done() const { return left_ == 0 && !chunked_; }
    bool body_failed() const { return failed_; }
    /// Status and sentence for the client if the body was incomplete; 0 if the client has disconnected.
    int failed_status() const { return failed_status_; }
    const std::string& failed_detail() const { return failed_detail_; }
    bool has_more() const { return !in_.empty(); }

    /// From now on each write is sent at once.
    void pass_on() { gathers_ = false; }
    bool flush();
    /// True if the client has disconnected, between two pieces of a stream or before an answer begins. The end of its
    /// own stream is not sufficient: the client may still read. After that end, one neutral piece is sent, to which the
    /// system of a client that has closed its socket responds with a reset.
    bool gone();
    /// The last answer is sent. Further input is dropped for a while, so that it does not reset the connection before
    /// the answer arrives.
    void linger();
    /// From any thread: wakes the thread that waits on the socket.
    void cut_off() const;
    /// From any thread: the rest of a body is refused within a second (kSocketTimeout), because another request needs
    /// the room.
    void give_way() { gives_way_ = true; }
    /// Since when it has waited for its client, for a head or for more of a body; empty if it does not wait.
    std::optional<Clock::time_point> waiting_since() const;

    ssize_t read(char* to, size_t size) override;
    ssize_t write(const char* from, size_t size) override;
    bool is_readable() const override { return true; }
    bool is_writable() const override { return !gone_; }
    void get_remote_ip_and_port(std::string&, int&) const override {}
    void get_local_ip_and_port(std::string&, int&) const override {}
    socket_t socket() const override { return fd_; }

    const std::string address;             ///< of the client, as text
    const std::string network;             ///< the address; for IPv6 its first 64 bits, the range of one customer
    std::atomic<bool> waiting = true;      ///< for a head, or lingering: no request in progress
    std::atomic<bool> begun = false;       ///< part of the head has arrived
    std::atomic<bool> receiving = false;   ///< waits for more of a body
    std::atomic<Clock::time_point> heard;  ///< when that wait began
    bool leaving = false;                  ///< gives way to another connection; used by the guard
    std::atomic<Clock::time_point> since;  ///< when the wait, or otherwise the request, began
    std::atomic<Clock::time_point> moved;  ///< when the client last read part of an answer

    /// Timeout of the socket itself (SO_RCVTIMEO).
    static constexpr std::chrono::seconds kSocketTimeout{1};

private:
    void rest();
    bool receive(std::chrono::nanoseconds patience);
    bool receive_body();
    bool next_chunk();
    bool take_line(std::string& line, std::size_t max, const char* rule);
    bool send(std::string_view bytes);
    bool reset() const;
    bool fail(int status, std::string detail);

    const int fd_;
    const ServerLimits& limits_;
    std::string in_;  ///< received but not used yet

    std::string_view head_;  ///< the part that the library has not read yet
    std::size_t left_ = 0;   ///< of the body, or of the current chunk
    bool chunked_ = false;   ///< another chunk follows
    bool first_chunk_ = false;
    std::size_t room_ = 0;     ///< for chunks
    bool asks_first_ = false;  ///< the client waits for 100 Continue
    bool at_pace_ = false;
    std::chrono::nanoseconds patience_{};  ///< remaining time for the body, or in the current window of its pace
    std::size_t come_ = 0;                 ///< bytes received in that window
    bool failed_ = false;
    int failed_status_ = 0;
    std::string failed_detail_;

    std::string out_;
    bool gathers_ = true;
    bool http_1_0_ = false;                ///< the client knows neither interim answers nor chunks
    std::atomic<bool> asked_ = false;      ///< the neutral piece that detects a closed socket was sent
    std::atomic<bool> gives_way_ = false;  ///< give_way()
    bool gone_ = false;
};

}  // namespace tunewright::server::http
