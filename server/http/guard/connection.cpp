#include "server/http/guard/connection.h"

#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>

namespace tunewright::server::http {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr std::size_t kMaxGathered = 16 * 1024;
constexpr std::size_t kMaxKeptCapacity = 32 * 1024;
constexpr std::size_t kMinBytesPerMs = 16;
constexpr std::size_t kMaxDropped = 256 * 1024;
constexpr std::size_t kMaxLingerBody = 64 * 1024 * 1024;
constexpr std::size_t kMaxSizeDigits = 8;

/// Errors and the end of the stream count as ready. False after the timeout.
bool wait_for(int fd, short what, nanoseconds patience) {
    pollfd entry{fd, what, 0};
    const auto whole = std::chrono::duration_cast<milliseconds>(patience) + milliseconds(1);
    return patience.count() > 0 && ::poll(&entry, 1, static_cast<int>(whole.count())) > 0;
}

}  // namespace

Connection::Connection(int fd, std::string client, std::string of_network, const ServerLimits& limits)
    : address(std::move(client)),
      network(std::move(of_network)),
      heard(Clock::now()),
      since(Clock::now()),
      moved(Clock::now()),
      fd_(fd),
      limits_(limits) {
    const timeval look{.tv_sec = kSocketTimeout.count(), .tv_usec = 0};
    ::setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &look, sizeof look);
}

Connection::~Connection() { ::close(fd_); }

// ---- reading ----

/// Waits for bytes and reads them; false if the client has disconnected or the time is over.
bool Connection::receive(nanoseconds patience) {
    std::array<char, 64 * 1024> piece;
    for (const auto end = Clock::now() + patience;;) {
        // The socket itself waits up to kSocketTimeout, which saves a call per request.
        const bool long_wait = end - Clock::now() > kSocketTimeout;
        const ssize_t n = ::recv(fd_, piece.data(), piece.size(), long_wait ? 0 : MSG_DONTWAIT);
        if (n > 0) return in_.append(piece.data(), static_cast<std::size_t>(n)), true;
        if (n == 0 || (errno != EAGAIN && errno != EINTR)) return gone_ = true, false;
        if (gives_way_) return false;
        if (!long_wait && !wait_for(fd_, POLLIN, end - Clock::now())) return false;
    }
}

std::optional<Head> Connection::next_head() {
    if (in_.capacity() > kMaxKeptCapacity) in_.shrink_to_fit();
    rest();
    if (in_ == "\r\n") in_.clear();  // after a body, beyond its length: no request begins with it
    if (in_.empty() && !receive(limits_.idle)) return std::nullopt;
    begun = true;
    const auto end = Clock::now() + limits_.head;
    for (std::size_t scanned = 0;;) {
        const Head head = may_be_read(in_, scanned) ? read_head(in_) : Head();
        if (head.state == Head::State::incomplete) {
            scanned = in_.size() < 3 ? 0 : in_.size() - 3;
            if (receive(end - Clock::now())) continue;
            if (gone_) return std::nullopt;
        }
        since = Clock::now();
        waiting = false;
        in_.erase(0, head.size);
        return head.state == Head::State::incomplete ? refuse(408, "The request did not arrive in time.") : head;
    }
}

void Connection::rest() {
    since = Clock::now();
    waiting = true;
    begun = !in_.empty();
}

void Connection::start(const Head& head, std::string_view text) {
    head_ = text;
    chunked_ = first_chunk_ = head.transfer == Head::Transfer::chunked;
    left_ = head.content_length;
    room_ = limits_.max_batch_body;
    asks_first_ = head.expects_continue;
    failed_ = false;
    gathers_ = true;
    http_1_0_ = head.http_1_0;
    asked_ = false;
    gives_way_ = false;
}

void Connection::expect_body(bool as_it_arrives) {
    at_pace_ = as_it_arrives;
    patience_ = at_pace_ ? limits_.pace_time : limits_.body_time;
    come_ = 0;
}

bool Connection::fail(int status, std::string detail) {
    failed_ = true;
    failed_status_ = gone_ ? 0 : status;
    failed_detail_ = std::move(detail);
    return false;
}

ssize_t Connection::read(char* to, size_t size) {
    if (!head_.empty()) {
        const size_t n = std::min(size, head_.size());
        std::memcpy(to, head_.data(), n);
        head_.remove_prefix(n);
        return static_cast<ssize_t>(n);
    }
    if (failed_ || (left_ == 0 && chunked_ && !next_chunk())) return -1;
    if (left_ == 0) return 0;
    if (in_.empty() && !receive_body()) return -1;
    const std::size_t n = std::min({size, left_, in_.size()});
    std::memcpy(to, in_.data(), n);
    in_.erase(0, n);
    left_ -= n;
    return static_cast<ssize_t>(n);
}

bool Connection::receive_body() {
    if (std::exchange(asks_first_, false) && !send("HTTP/1.1 100 Continue\r\n\r\n")) return fail(0, {});
    const auto start = Clock::now();
    const std::size_t before = in_.size();
    heard = start;
    receiving = true;
    const bool came = receive(patience_);
    receiving = false;
    if (!came && gives_way_) return refuse_body("Other requests need the memory of this one; send it again later.");
    if (!came) return fail(408, at_pace_ ? "The body arrives too slowly." : "The body did not arrive in time.");
    patience_ -= Clock::now() - start;
    come_ += in_.size() - before;
    if (!at_pace_ || come_ < limits_.pace_bytes) return true;
    come_ = 0;
    patience_ = limits_.pace_time;
    return true;
}

/// The next line of the body without its CR LF, of at most `max` bytes.
bool Connection::take_line(std::string& line, std::size_t max, const char* rule) {
    for (std::size_t end = 0; (end = in_.find('\n')) == std::string::npos || end > max + 1;) {
        if (in_.size() > max + 1) return fail(400, rule);
        if (!receive_body()) return false;
    }
    line = in_.substr(0, in_.find('\n'));
    in_.erase(0, line.size() + 1);
    if (line.empty() || line.back() != '\r') return fail(400, rule);
    line.pop_back();
    return true;
}

/// Strict: no extensions, no trailers. Input that two parsers could read differently is refused.
bool Connection::next_chunk() {
    constexpr const char* ends = "A chunk must end with CR LF, without extensions or trailers.";
    constexpr const char* sizes = "The size of a chunk must be 1 to 8 hexadecimal digits, without extensions.";
    std::string line;
    if (!std::exchange(first_chunk_, false) && !take_line(line, 0, ends)) return false;
    if (!take_line(line, kMaxSizeDigits, sizes)) return false;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), left_, 16);
    if (error != std::errc{} || end != line.data() + line.size()) return fail(400, sizes);
    if (left_ > room_) return fail(413, "The chunks exceed the largest body that is accepted.");
    room_ -= left_;
    chunked_ = left_ > 0;
    return chunked_ || take_line(line, 0, ends);
}

bool Connection::drop_body() {
    if (left_ > kMaxDropped || (asks_first_ && !body_done())) return false;
    patience_ = {};
    std::array<char, 4096> piece;
    for (std::size_t dropped = 0; !failed_ && !body_done() && dropped <= kMaxDropped;)
        dropped += static_cast<std::size_t>(std::max<ssize_t>(read(piece.data(), piece.size()), 0));
    return !failed_ && body_done();
}

// ---- writing ----

ssize_t Connection::write(const char* from, size_t size) {
    const std::string_view bytes(from, size);
    const bool fits = gathers_ && out_.size() + size <= kMaxGathered;
    if (fits) out_.append(bytes);
    return fits || (flush() && send(bytes)) ? static_cast<ssize_t>(size) : -1;
}

bool Connection::flush() { return out_.empty() || send(std::exchange(out_, {})); }

bool Connection::send(std::string_view bytes) {
    const auto end = Clock::now() + limits_.writing + milliseconds(bytes.size() / kMinBytesPerMs);
    while (!bytes.empty() && !gone_) {
        const ssize_t n = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (n >= 0) {
            bytes.remove_prefix(static_cast<std::size_t>(n));
            moved = Clock::now();
        } else if (errno == EAGAIN) {
            gone_ = !wait_for(fd_, POLLOUT, end - Clock::now());
        } else {
            gone_ = errno != EINTR;
        }
    }
    return !gone_;
}

/// Both directions are closed, by a reset or by the server.
bool Connection::reset() const {
    pollfd entry{fd_, 0, 0};
    return ::poll(&entry, 1, 0) > 0 && (entry.revents & (POLLHUP | POLLERR)) != 0;
}

bool Connection::gone() {
    if (gone_ || reset()) return true;
    pollfd entry{fd_, POLLRDHUP, 0};
    if (::poll(&entry, 1, 0) <= 0 || http_1_0_ || !body_done() || !out_.empty()) return false;
    if (asked_.exchange(true)) return false;
    // An interim answer may be sent at any time before the answer; a chunk's size may begin with any number of zeros.
    const std::string_view nothing = gathers_ ? "HTTP/1.1 100 Continue\r\n\r\n" : "0";
    ::send(fd_, nothing.data(), nothing.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    return reset();
}

void Connection::linger() {
    ::shutdown(fd_, SHUT_WR);
    in_.clear();
    gives_way_ = false;
    rest();
    std::size_t allowance = std::max(left_ <= kMaxLingerBody ? left_ : 0, kMaxDropped);
    const auto end = Clock::now() + limits_.lingering;
    for (; !gone_ && receive(end - Clock::now()) && in_.size() <= allowance; in_.clear()) allowance -= in_.size();
}

void Connection::cut_off() const { ::shutdown(fd_, SHUT_RDWR); }

std::optional<Connection::Clock::time_point> Connection::waiting_since() const {
    if (waiting) return since.load();
    if (receiving) return heard.load();
    return std::nullopt;
}

}  // namespace tunewright::server::http
