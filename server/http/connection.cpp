#include "server/http/connection.h"

#include <sys/socket.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>

namespace tunewright::server::http {
namespace {

constexpr std::size_t kChunk = 64 * 1024;
constexpr std::size_t kKeptCapacity = 32 * 1024;

bool would_block() { return errno == EAGAIN || errno == EWOULDBLOCK; }

}  // namespace

Connection::~Connection() { ::close(fd_); }

Connection::Io Connection::receive(std::size_t body_limit) {
    thread_local std::array<char, kChunk> chunk;
    for (;;) {
        std::size_t want = 4096;
        if (head_.state == Head::State::complete)
            want = std::max(
                want, head_.size + head_.content_length - std::min(in_.size(), head_.size + head_.content_length));
        const std::size_t room = std::min(want, chunk.size());
        const ssize_t n = ::recv(fd_, chunk.data(), room, 0);
        if (n == 0) return Io::gone;
        if (n < 0) {
            if (errno == EINTR) continue;
            readable = false;
            return would_block() ? Io::again : Io::gone;
        }
        in_.append(chunk.data(), static_cast<std::size_t>(n));
        // A short read has emptied the socket, unless the end of the stream is waiting behind it.
        const bool drained = static_cast<std::size_t>(n) < room && !peer_closed;
        readable = !drained;
        if (frame(body_limit).state == Head::State::refused || request_complete()) return Io::done;
        if (drained) return Io::again;
    }
}

const Head& Connection::frame(std::size_t body_limit) {
    if (head_.state != Head::State::incomplete || in_.empty()) return head_;
    const bool ended = in_.find("\r\n\r\n", scanned_) != std::string::npos;
    if (ended || in_.size() > kMaxLineBytes) {
        head_ = read_head(in_, body_limit);
        if (head_.state == Head::State::complete) in_.reserve(head_.size + head_.content_length);
    }
    scanned_ = in_.size() < 3 ? 0 : in_.size() - 3;
    return head_;
}

bool Connection::request_complete() const {
    return head_.state == Head::State::complete && in_.size() >= head_.size + head_.content_length;
}

std::string Connection::take_body() {
    const std::size_t total = head_.size + head_.content_length;
    std::string body = in_.substr(head_.size, head_.content_length);
    in_.erase(0, total);
    if (in_.capacity() > kKeptCapacity) in_.shrink_to_fit();
    head_ = {};
    scanned_ = 0;
    continued_ = false;
    return body;
}

void Connection::start_answer(Response response, bool keep_alive) {
    keep_alive_ = keep_alive;
    out_head_ = render_head(response, keep_alive);
    out_body_ = response.body_omitted ? std::string{} : std::move(response.body);
    sent_ = 0;
    state = State::writing;
}

Connection::Io Connection::send() {
    const std::size_t total = out_head_.size() + out_body_.size();
    while (sent_ < total) {
        std::array<iovec, 2> parts{};
        msghdr message{};
        message.msg_iov = parts.data();
        const std::size_t from_head = std::min(sent_, out_head_.size());
        const std::size_t from_body = sent_ - from_head;
        if (from_head < out_head_.size())
            parts[message.msg_iovlen++] = {out_head_.data() + from_head, out_head_.size() - from_head};
        if (from_body < out_body_.size())
            parts[message.msg_iovlen++] = {out_body_.data() + from_body, out_body_.size() - from_body};
        const ssize_t n = ::sendmsg(fd_, &message, MSG_NOSIGNAL);
        if (n < 0) {
            if (errno == EINTR) continue;
            return would_block() ? Io::again : Io::gone;
        }
        sent_ += static_cast<std::size_t>(n);
    }
    out_head_.clear();
    out_body_ = {};
    return Io::done;
}

void Connection::send_continue() {
    if (continued_ || !head_.expects_continue || head_.state != Head::State::complete || request_complete()) return;
    continued_ = true;
    constexpr std::string_view text = "HTTP/1.1 100 Continue\r\n\r\n";
    [[maybe_unused]] const ssize_t n = ::send(fd_, text.data(), text.size(), MSG_NOSIGNAL);
}

void Connection::start_lingering(std::size_t allowance) {
    state = State::lingering;
    linger_left_ = allowance;
    in_ = {};
    ::shutdown(fd_, SHUT_WR);
}

Connection::Io Connection::discard() {
    std::array<char, 16 * 1024> chunk;
    for (;;) {
        const ssize_t n = ::recv(fd_, chunk.data(), chunk.size(), 0);
        if (n == 0 || (n < 0 && !would_block())) return Io::gone;
        if (n < 0) return Io::again;
        if (static_cast<std::size_t>(n) > linger_left_) return Io::gone;
        linger_left_ -= static_cast<std::size_t>(n);
    }
}

}  // namespace tunewright::server::http
