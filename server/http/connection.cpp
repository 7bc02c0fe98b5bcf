#include "server/http/connection.h"

#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

namespace tunewright::server::http {
namespace {

constexpr std::size_t kChunk = 64 * 1024;
constexpr std::size_t kKeptCapacity = 32 * 1024;
constexpr std::size_t kLingerAllowance = 256 * 1024;
constexpr std::size_t kLingerBodyMost = 64 * 1024 * 1024;

thread_local std::array<char, kChunk> received;

bool would_block() { return errno == EAGAIN || errno == EWOULDBLOCK; }

}  // namespace

Connection::~Connection() {
    if (incoming) incoming->finish(BodySource::State::gone);
    ::close(fd_);
}

Io Connection::receive() {
    for (;;) {
        const bool in_body = head_.state == Head::State::complete;
        const std::size_t whole = head_.size + head_.content_length;
        const std::size_t want = in_body && whole > in_.size() ? whole - in_.size() : 0;
        const std::size_t room = std::clamp<std::size_t>(want, 4096, received.size());
        const ssize_t n = ::recv(fd_, received.data(), room, 0);
        if (n == 0) return Io::gone;
        if (n < 0) {
            if (errno == EINTR) continue;
            readable = false;
            return would_block() ? Io::again : Io::gone;
        }
        in_.append(received.data(), static_cast<std::size_t>(n));
        // A short read has emptied the socket, unless the end of the stream is waiting behind it.
        readable = static_cast<std::size_t>(n) == room || peer_closed;
        if (in_body ? request_ready() : frame().state != Head::State::incomplete) return Io::done;
        if (!readable) return Io::again;
    }
}

const Head& Connection::frame() {
    if (head_.state != Head::State::incomplete || in_.empty()) return head_;
    const bool ended = in_.find("\r\n\r\n", scanned_) != std::string::npos;
    if (ended || in_.size() > kMaxLineBytes) head_ = read_head(in_);
    scanned_ = in_.size() < 3 ? 0 : in_.size() - 3;
    return head_;
}

void Connection::admit(Request request, bool streamed, std::size_t body_limit) {
    refuse_body(head_, streamed, body_limit);
    if (head_.state != Head::State::complete) return;
    request_ = std::move(request);
    streamed_ = streamed;
    wants_continue_ = head_.expects_continue;
    chunks_ = !head_.http_1_0;
    keep_alive_ = head_.keep_alive;
    if (!streamed) in_.reserve(head_.size + head_.content_length);
}

void Connection::refuse(int status, std::string detail) {
    head_.state = Head::State::refused;
    head_.status = status;
    head_.detail = std::move(detail);
}

bool Connection::request_ready() const {
    return request_ && (streamed_ || in_.size() >= head_.size + head_.content_length);
}

Request Connection::take_request() {
    Request request = *std::exchange(request_, std::nullopt);
    const std::size_t total = head_.size + (streamed_ ? 0 : head_.content_length);
    if (!streamed_) request.body = in_.substr(head_.size, head_.content_length);
    in_.erase(0, total);
    if (in_.capacity() > kKeptCapacity) in_.shrink_to_fit();
    head_ = {};
    scanned_ = 0;
    return request;
}

Io Connection::receive_body(std::string& piece) {
    BodyDecoder& decoder = incoming->decoder;
    for (;;) {
        in_.erase(0, decoder.decode(in_, piece, IncomingBody::kPiece - piece.size()));
        if (decoder.state() != BodyDecoder::State::more || piece.size() == IncomingBody::kPiece) return Io::done;
        const ssize_t n = readable ? ::recv(fd_, received.data(), received.size(), 0) : -1;
        if (n < 0 && readable && errno == EINTR) continue;
        if (n == 0 || (n < 0 && readable && !would_block())) return piece.empty() ? Io::gone : Io::done;
        if (n < 0) {
            readable = false;
            return piece.empty() ? Io::again : Io::done;
        }
        readable = static_cast<std::size_t>(n) == received.size() || peer_closed;
        in_.append(received.data(), static_cast<std::size_t>(n));
    }
}

void Connection::start_answer(Response response, bool keep_alive, const std::function<void()>& wake) {
    const bool body_left = incoming && incoming->decoder.state() != BodyDecoder::State::done;
    keep_alive_ = keep_alive && keep_alive_ && !body_left && (chunks_ || !response.stream);
    out.start(std::move(response), keep_alive_, chunks_, wake);
    state = State::writing;
}

void Connection::send_continue() {
    if (!std::exchange(wants_continue_, false) || request_ready() || (!request_ && !in_.empty())) return;
    constexpr std::string_view text = "HTTP/1.1 100 Continue\r\n\r\n";
    [[maybe_unused]] const ssize_t n = ::send(fd_, text.data(), text.size(), MSG_NOSIGNAL);
}

void Connection::start_lingering() {
    const std::size_t announced = incoming ? incoming->decoder.remaining() : head_.content_length;
    linger_left_ = announced <= kLingerBodyMost ? std::max(announced, kLingerAllowance) : kLingerAllowance;
    state = State::lingering;
    in_ = {};
    incoming.reset();
    ::shutdown(fd_, SHUT_WR);
}

Io Connection::discard() {
    for (;;) {
        const ssize_t n = ::recv(fd_, received.data(), received.size(), 0);
        if (n == 0 || (n < 0 && !would_block())) return Io::gone;
        if (n < 0) return Io::again;
        if (static_cast<std::size_t>(n) > linger_left_) return Io::gone;
        linger_left_ -= static_cast<std::size_t>(n);
    }
}

}  // namespace tunewright::server::http
