#include "server/http/outgoing.h"

#include <fmt/format.h>

#include <sys/socket.h>
#include <sys/uio.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

namespace tunewright::server::http {
namespace {

constexpr std::string_view kEndOfChunk = "\r\n";
constexpr std::string_view kEndOfChunkAndBody = "\r\n0\r\n\r\n";
constexpr std::string_view kEndOfBody = "0\r\n\r\n";

bool is_event_stream(const Response& response) {
    return std::ranges::any_of(response.headers, [](const auto& header) {
        return header.first == "Content-Type" && header.second.starts_with("text/event-stream");
    });
}

std::string size_line(std::size_t size) { return fmt::format("{:x}\r\n", size); }

}  // namespace

void Outgoing::start(Response response, bool keep_alive, bool chunks, const std::function<void()>& wake) {
    abandon();
    chunks_ = chunks;
    const Framing framing = !response.stream ? Framing::length : chunks ? Framing::chunked : Framing::until_close;
    head_ = render_head(response, keep_alive, framing);
    body_.clear();
    tail_size_ = sent_ = progress_ = 0;
    last_ = true;
    broken_ = false;
    stream_ = std::move(response.stream);
    if (stream_ && response.body_omitted) {
        abandon();
    } else if (stream_) {
        endless_ = is_event_stream(response);
        last_ = false;
        stream_->attach(wake);
        next_piece();
    } else if (!response.body_omitted) {
        body_ = std::move(response.body);
    }
}

/// Puts what the stream has written behind what is being sent; false where there is nothing.
bool Outgoing::next_piece() {
    BodyStream::Written written = stream_->take();
    if (written.bytes.empty() && !written.ended) return false;
    last_ = written.ended;
    broken_ = written.broken;
    std::string_view tail;
    if (chunks_) {
        const bool whole = last_ && !broken_;
        if (!written.bytes.empty()) head_.append(size_line(written.bytes.size()));
        if (!written.bytes.empty()) tail = whole ? kEndOfChunkAndBody : kEndOfChunk;
        if (written.bytes.empty() && whole) tail = kEndOfBody;
    }
    body_ = std::move(written.bytes);
    tail_ = tail.data();
    tail_size_ = tail.size();
    return true;
}

Io Outgoing::send_parts(int fd) {
    const std::size_t total = head_.size() + body_.size() + tail_size_;
    while (sent_ < total) {
        std::array<iovec, 3> parts{};
        msghdr message{};
        message.msg_iov = parts.data();
        std::size_t skip = sent_;
        const auto add = [&](const char* data, std::size_t size) {
            if (skip < size) parts[message.msg_iovlen++] = {const_cast<char*>(data) + skip, size - skip};
            skip -= std::min(skip, size);
        };
        add(head_.data(), head_.size());
        add(body_.data(), body_.size());
        add(tail_, tail_size_);
        const ssize_t n = ::sendmsg(fd, &message, MSG_NOSIGNAL);
        if (n < 0) {
            if (errno == EINTR) continue;
            return errno == EAGAIN || errno == EWOULDBLOCK ? Io::again : Io::gone;
        }
        sent_ += static_cast<std::size_t>(n);
        progress_ += static_cast<std::size_t>(n);
    }
    head_.clear();
    body_ = {};
    tail_size_ = sent_ = 0;
    return Io::done;
}

Io Outgoing::send(int fd) {
    const Io io = send_parts(fd);
    if (io != Io::done) return io;
    if (stream_) stream_->taken();
    if (broken_) return Io::gone;
    if (last_) {
        if (stream_) std::exchange(stream_, nullptr)->close(false);
        return Io::done;
    }
    if (next_piece()) return Io::more;
    stream_->ask();
    return Io::idle;
}

void Outgoing::end_stream() {
    if (!stream_) return;
    const bool sending = !head_.empty() || !body_.empty() || tail_size_ > 0;
    if (!sending) next_piece();
    if (!last_ && chunks_) {
        const bool in_chunk = tail_size_ > 0;
        tail_ = in_chunk ? kEndOfChunkAndBody.data() : kEndOfBody.data();
        tail_size_ = in_chunk ? kEndOfChunkAndBody.size() : kEndOfBody.size();
    }
    last_ = true;
    std::exchange(stream_, nullptr)->close(true);
}

std::size_t Outgoing::pending() const {
    return stream_ ? stream_->waiting() : head_.size() + body_.size() - std::min(sent_, head_.size() + body_.size());
}

void Outgoing::abandon() {
    if (stream_) std::exchange(stream_, nullptr)->close(true);
}

void Outgoing::abandon(const std::shared_ptr<BodyStream>& stream, bool notify) {
    if (stream) stream->close(notify);
}

}  // namespace tunewright::server::http
