// One client's connection, as the serving library reads and writes it: the head that the guard has checked, then the
// body, freed of its chunks; never a byte of the next request. Every wait has an end.
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

    /// Waits for the next head, which may be a refusal; nothing where the client has gone or sends none.
    std::optional<Head> next_head();

    /// The library reads this from now on, and behind it the body that `head` announces.
    void start(const Head& head, std::string_view text);
    /// The body is gathered within `body_time`, or comes as it is read, at a pace.
    void expect_body(bool as_it_arrives);
    /// The body cannot be taken: 503 with this sentence. Always false.
    bool refuse_body(std::string detail) { return fail(503, std::move(detail)); }
    /// Drops what has come of the body. False: some is still on its way.
    bool drop_body();
    bool body_done() const { return left_ == 0 && !chunked_; }
    bool body_failed() const { return failed_; }
    /// Where the body did not come to its end: status and sentence for the client; 0 where the client has gone.
    int failed_status() const { return failed_status_; }
    const std::string& failed_detail() const { return failed_detail_; }
    bool has_more() const { return !in_.empty(); }

    /// From now on each write goes out at once.
    void pass_on() { gathers_ = false; }
    bool flush();
    /// True where the client has gone, between two pieces of a stream or before an answer begins. The end of what it
    /// sends is no sign of that: it may read on. Where that end has come, it is sent what changes nothing, once, to
    /// which the system of a client that has closed its socket answers with a reset.
    bool gone();
    /// The last answer is out. What still comes is dropped for a while, so that the answer survives.
    void linger();
    /// From any thread: wakes who waits on the socket.
    void cut_off() const;
    /// From any thread: the rest of a body is refused within a second (kSocketTimeout), as another needs the room.
    void give_way() { gives_way_ = true; }
    /// Since when it has waited for its client, for a head or for more of a body; nothing while it does not.
    std::optional<Clock::time_point> waiting_since() const;

    ssize_t read(char* to, size_t size) override;
    ssize_t write(const char* from, size_t size) override;
    bool is_readable() const override { return true; }
    bool is_writable() const override { return !gone_; }
    void get_remote_ip_and_port(std::string&, int&) const override {}
    void get_local_ip_and_port(std::string&, int&) const override {}
    socket_t socket() const override { return fd_; }

    const std::string address;             ///< of the client, as text
    const std::string network;             ///< the same, of IPv6 its first 64 bits, which is what one customer gets
    std::atomic<bool> waiting = true;      ///< for a head, or lingering: no request is under way
    std::atomic<bool> begun = false;       ///< and some of the head has come
    std::atomic<bool> receiving = false;   ///< waits for more of a body
    std::atomic<Clock::time_point> heard;  ///< when that wait began
    bool leaving = false;                  ///< gives way to another; of the guard
    std::atomic<Clock::time_point> since;  ///< when the wait, or else the request, began
    std::atomic<Clock::time_point> moved;  ///< when the client took something of an answer

    /// What its socket waits for by itself (SO_RCVTIMEO).
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
    std::string in_;  ///< received and not used up

    std::string_view head_;  ///< what the library has not read of it
    std::size_t left_ = 0;   ///< of the body, or of its present chunk
    bool chunked_ = false;   ///< and another chunk follows
    bool first_chunk_ = false;
    std::size_t room_ = 0;     ///< for chunks
    bool asks_first_ = false;  ///< the client waits for 100 Continue
    bool at_pace_ = false;
    std::chrono::nanoseconds patience_{};  ///< left of the body's time, or of the present window of its pace
    std::size_t come_ = 0;                 ///< in that window
    bool failed_ = false;
    int failed_status_ = 0;
    std::string failed_detail_;

    std::string out_;
    bool gathers_ = true;
    bool http_1_0_ = false;                ///< the client knows neither interim answers nor chunks
    std::atomic<bool> asked_ = false;      ///< has been sent what shows whether it has gone
    std::atomic<bool> gives_way_ = false;  ///< give_way()
    bool gone_ = false;
};

}  // namespace tunewright::server::http
