#include "bench/load/client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <stdexcept>
#include <utility>

namespace tunewright::load {
namespace {

std::string& always() {
    static std::string fields;
    return fields;
}

/// Position of a field's value in a head, npos where it is missing. Names of fields are compared without case.
std::size_t value_of(std::string_view head, std::string_view name) {
    const auto same = [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a + 32 : a) == b; };
    for (std::size_t line = head.find("\r\n"); line != std::string_view::npos; line = head.find("\r\n", line)) {
        line += 2;
        if (head.size() - line <= name.size() || head[line + name.size()] != ':') continue;
        if (std::equal(name.begin(), name.end(), head.begin() + static_cast<std::ptrdiff_t>(line),
                       [&](char a, char b) { return same(b, a); }))
            return line + name.size() + 1;
    }
    return std::string_view::npos;
}

std::string_view field(std::string_view head, std::string_view name) {
    std::size_t from = value_of(head, name);
    if (from == std::string_view::npos) return {};
    while (from < head.size() && head[from] == ' ') from++;
    return head.substr(from, head.find("\r\n", from) - from);
}

/// Takes the chunks of a body apart. False until the last one is there; `at` is then the end of the body.
bool unchunk(std::string_view in, std::size_t& at, std::string& body) {
    for (;;) {
        const std::size_t line_end = in.find("\r\n", at);
        if (line_end == std::string_view::npos) return false;
        std::size_t size = 0;
        std::from_chars(in.data() + at, in.data() + line_end, size, 16);
        const std::size_t data = line_end + 2;
        if (in.size() < data + size + 2) return false;
        body.append(in.substr(data, size));
        at = data + size + 2;
        if (size == 0) return true;
    }
}

}  // namespace

std::string Answer::header(std::string_view name) const { return std::string(field(head, name)); }

void send_always(std::string fields) { always() = std::move(fields); }

std::string get(std::string_view target, std::string_view fields) {
    std::string out = "GET ";
    out.append(target).append(" HTTP/1.1\r\nHost: localhost\r\n").append(always()).append(fields).append("\r\n");
    return out;
}

std::string post(std::string_view target, std::string_view body, std::string_view fields) {
    std::string out = "POST ";
    out.append(target).append(" HTTP/1.1\r\nHost: localhost\r\n");
    if (fields.find("Content-Type") == std::string_view::npos) out.append("Content-Type: application/json\r\n");
    out.append(always()).append(fields).append("Content-Length: ");
    out.append(std::to_string(body.size())).append("\r\n\r\n").append(body);
    return out;
}

struct Client::Connection {
    Id id = 0;
    int fd = -1;
    std::string out;
    std::size_t sent = 0;
    std::string in;
    std::uint64_t received = 0;
    std::size_t chunks_at = 0;  ///< where the next chunk of a chunked body starts; 0: not known yet
    std::string chunked_body;
    bool again = false;  ///< the request has been sent anew on a fresh connection
    Clock::time_point since;
    Then then;
};

Client::Client(int port) : port_(port), epoll_(::epoll_create1(EPOLL_CLOEXEC)), buffer_(1 << 18) {}

Client::~Client() {
    for (const auto& [id, connection] : connections_)
        if (connection->fd >= 0) ::close(connection->fd);
    ::close(epoll_);
}

void Client::connect(Connection& connection) {
    connection.fd = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port_));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (connection.fd < 0 || ::connect(connection.fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        throw std::runtime_error("no connection to 127.0.0.1:" + std::to_string(port_));
    const int on = 1;
    ::setsockopt(connection.fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.u64 = connection.id;
    ::epoll_ctl(epoll_, EPOLL_CTL_ADD, connection.fd, &event);
}

Client::Id Client::open() {
    auto made = std::make_unique<Connection>();
    made->id = next_++;
    connect(*made);
    const Id id = made->id;
    connections_.emplace(id, std::move(made));
    return id;
}

void Client::send(Id id, std::string request, Then then) {
    Connection& connection = *connections_.at(id);
    if (connection.fd < 0) connect(connection);
    connection.out = std::move(request);
    connection.sent = 0;
    connection.in.clear();
    connection.chunks_at = 0;
    connection.chunked_body.clear();
    connection.again = false;
    connection.then = std::move(then);
    connection.since = Clock::now();
    flush(connection);
}

bool Client::send_raw(Id id, std::string_view bytes) {
    Connection& connection = *connections_.at(id);
    return connection.fd >= 0 && ::send(connection.fd, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT) ==
                                     static_cast<ssize_t>(bytes.size());
}

bool Client::head_received(Id id) const {
    return connections_.at(id)->in.find("\r\n\r\n") != std::string::npos || connections_.at(id)->chunks_at > 0;
}

bool Client::is_open(Id id) const { return connections_.at(id)->fd >= 0; }

std::uint64_t Client::received(Id id) const { return connections_.at(id)->received; }

void Client::close(Id id) {
    const auto found = connections_.find(id);
    if (found == connections_.end()) return;
    if (found->second->fd >= 0) ::close(found->second->fd);
    connections_.erase(found);
}

void Client::flush(Connection& connection) {
    while (connection.sent < connection.out.size()) {
        const ssize_t n = ::send(connection.fd, connection.out.data() + connection.sent,
                                 connection.out.size() - connection.sent, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0 && errno != EAGAIN) return lose(connection);
        if (n < 0) break;
        connection.sent += static_cast<std::size_t>(n);
    }
    epoll_event event{};
    event.events = EPOLLIN;
    if (connection.sent < connection.out.size()) event.events |= EPOLLOUT;
    event.data.u64 = connection.id;
    // Only a request too large for the socket's buffer has to wait for room, and is then watched until it is out.
    if (connection.sent < connection.out.size() || connection.out.size() > (1U << 16))
        ::epoll_ctl(epoll_, EPOLL_CTL_MOD, connection.fd, &event);
}

void Client::lose(Connection& connection) {
    if (connection.fd >= 0) ::close(connection.fd);
    connection.fd = -1;
    // An idle connection may be closed by the server just when the next request is sent: once more on a fresh one.
    if (connection.then && !connection.again && connection.in.empty()) {
        connection.again = true;
        connection.sent = 0;
        connect(connection);
        return flush(connection);
    }
    if (connection.then) finish(connection, {});
}

void Client::finish(Connection& connection, Answer answer) {
    answer.seconds = std::chrono::duration<double>(Clock::now() - connection.since).count();
    const Then then = std::exchange(connection.then, nullptr);
    if (then) then(connection.id, std::move(answer));
}

/// True where a whole answer was there; its receiver has been notified.
bool Client::take_answer(Connection& connection) {
    std::string& in = connection.in;
    const std::size_t head_end = in.find("\r\n\r\n");
    if (head_end == std::string::npos) return false;
    const std::string_view head = std::string_view(in).substr(0, head_end + 2);
    if (head.substr(9, 3) == "100") {
        in.erase(0, head_end + 4);
        return take_answer(connection);
    }
    Answer answer;
    std::from_chars(head.data() + 9, head.data() + 12, answer.status);
    std::size_t end = head_end + 4;
    if (field(head, "transfer-encoding") == "chunked") {
        if (connection.chunks_at == 0) connection.chunks_at = end;
        if (!unchunk(in, connection.chunks_at, connection.chunked_body)) {
            // What has been taken apart need not be kept: a stream may be long.
            if (connection.chunks_at > (1U << 20)) {
                in.erase(end, connection.chunks_at - end);
                connection.chunks_at = end;
            }
            return false;
        }
        answer.body = std::move(connection.chunked_body);
    } else {
        const std::string_view length = field(head, "content-length");
        std::size_t size = 0;
        std::from_chars(length.data(), length.data() + length.size(), size);
        if (in.size() < end + size) return false;
        answer.body = in.substr(end, size);
    }
    answer.head = std::string(head);
    if (field(head, "connection") == "close") {
        ::close(connection.fd);
        connection.fd = -1;
    }
    finish(connection, std::move(answer));
    return true;
}

void Client::receive(Connection& connection) {
    const ssize_t n = ::recv(connection.fd, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
    if (n < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (n <= 0) return lose(connection);
    connection.received += static_cast<std::uint64_t>(n);
    connection.in.append(buffer_.data(), static_cast<std::size_t>(n));
    if (connection.then) take_answer(connection);
}

void Client::run_until(const std::function<bool()>& done, Clock::time_point end) {
    std::array<epoll_event, 256> events{};
    while (!done()) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(end - Clock::now()).count();
        if (left <= 0) return;
        const int n = ::epoll_wait(epoll_, events.data(), static_cast<int>(events.size()),
                                   static_cast<int>(std::min<long>(left, 20)));
        for (int i = 0; i < n; i++) {
            const auto found = connections_.find(events[i].data.u64);
            if (found == connections_.end() || found->second->fd < 0) continue;
            if ((events[i].events & EPOLLOUT) != 0) flush(*found->second);
            const auto still = connections_.find(events[i].data.u64);
            if (still != connections_.end() && still->second->fd >= 0 && (events[i].events & ~EPOLLOUT) != 0)
                receive(*still->second);
        }
    }
}

Answer Client::call(const std::string& request, std::chrono::seconds patience) {
    Answer got;
    bool there = false;
    const Id id = open();
    send(id, request, [&](Id, Answer answer) {
        got = std::move(answer);
        there = true;
    });
    run_until([&] { return there; }, Clock::now() + patience);
    close(id);
    return got;
}

}  // namespace tunewright::load
