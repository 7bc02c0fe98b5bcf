// libFuzzer on what a client sends: the bytes of one connection, through a real socket into the framing of requests,
// whole and cut at random. Promises: what is understood does not depend on the cuts; nothing is read past a refusal;
// no body is longer than its limit.
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <random>
#include <string>

#include "server/http/connection.h"
#include "server/http/parser.h"

namespace {

using namespace tunewright::server::http;

constexpr std::size_t kMaxBody = 3000;
constexpr std::size_t kMaxStreamedBody = 5000;

void require(bool holds, const char* what, const std::string& detail = "") {
    if (holds) return;
    std::cerr << "broken promise: " << what << "\n" << detail << "\n";
    std::abort();
}

/// The server's part of reading, without its answers: writes down what was understood.
class Reading {
public:
    explicit Reading(int fd) : connection_(fd, "test") {}

    /// Reads until the socket is empty or no more would be read from it.
    void go_on() {
        connection_.readable = true;
        while (!over_ && (connection_.incoming ? read_body() : read_request())) {
        }
    }

    bool over() const { return over_; }

    std::string transcript() const { return text_ + (over_ ? "over" : "open") + body_; }

private:
    /// False where nothing more can be done for now.
    bool read_request() {
        const Head& head = connection_.frame();
        if (head.state == Head::State::complete && !connection_.admitted()) admit(head);
        if (connection_.frame().state == Head::State::refused) return end(connection_.frame().status);
        if (connection_.request_ready()) return take();
        return connection_.readable && connection_.receive() == Io::done;
    }

    void admit(const Head& head) {
        std::optional<Request> request = parser_.parse(head.clean);
        if (!request) return connection_.refuse(400, "");
        const bool streamed = request->target.starts_with("/s");
        connection_.admit(*std::move(request), streamed, streamed ? kMaxStreamedBody : kMaxBody);
    }

    bool take() {
        const Head head = connection_.frame();
        if (connection_.streamed())
            connection_.incoming = std::make_shared<IncomingBody>(head.transfer == Head::Transfer::chunked
                                                                      ? BodyDecoder::of_chunks(kMaxStreamedBody)
                                                                      : BodyDecoder::of_length(head.content_length),
                                                                  mailbox_, Mailbox::Address{});
        else
            require(head.transfer == Head::Transfer::length, "chunks only where bodies are streamed");
        const Request request = connection_.take_request();
        require(request.body.size() <= kMaxBody, "a body within its limit");
        text_ += request.method + " " + request.target + "|";
        for (const auto& [name, value] : request.headers) text_ += name + ":" + value + "|";
        text_ += request.body + "\n";
        if (!connection_.keeps_alive()) closing_ = true;
        if (!connection_.incoming && closing_) return end(200);
        return true;
    }

    bool read_body() {
        std::string piece;
        const Io io = connection_.receive_body(piece);
        require(piece.size() <= IncomingBody::kPiece, "a piece within its limit");
        body_ += piece;
        require(body_.size() <= kMaxStreamedBody, "a streamed body within its limit");
        const BodyDecoder& decoder = connection_.incoming->decoder;
        if (!piece.empty()) return true;
        if (decoder.state() == BodyDecoder::State::refused) return end(decoder.status());
        if (decoder.state() != BodyDecoder::State::done) return io == Io::done;
        text_ += body_ + "\n";
        body_.clear();
        connection_.incoming.reset();
        return closing_ ? end(200) : true;
    }

    bool end(int status) {
        text_ += std::to_string(status) + " ";
        over_ = true;
        return false;
    }

    Connection connection_;
    Parser parser_;
    std::shared_ptr<Mailbox> mailbox_ = std::make_shared<Mailbox>();
    std::string text_;
    std::string body_;
    bool closing_ = false;
    bool over_ = false;
};

template <class Cut>
std::string understood(std::string_view bytes, const Cut& next_size) {
    int ends[2];
    require(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends) == 0, "a pair of sockets");
    Reading reading(ends[0]);
    while (!bytes.empty() && !reading.over()) {
        const std::size_t n = std::min(bytes.size(), next_size());
        require(::send(ends[1], bytes.data(), n, MSG_NOSIGNAL) == static_cast<ssize_t>(n), "room in the socket");
        bytes.remove_prefix(n);
        reading.go_on();
    }
    ::close(ends[1]);
    return reading.transcript();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size < 1 || size > 40'000) return 0;
    const std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
    const std::string whole = understood(bytes, [&] { return bytes.size(); });
    std::minstd_rand random(data[0] + 1U);
    const std::size_t longest = size > 4000 ? 4000 : 1 + random() % 60;
    const std::string cut = understood(bytes, [&] { return 1 + random() % longest; });
    require(cut == whole, "the same however the bytes are cut", "whole: " + whole + "\ncut: " + cut);
    return 0;
}
