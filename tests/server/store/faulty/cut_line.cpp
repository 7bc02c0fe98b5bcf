#include "tests/server/store/faulty/cut_line.h"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

namespace tunewright::server {
namespace {

sockaddr_in loopback(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    return address;
}

bool send_all(int to, const char* bytes, std::size_t count) {
    while (count > 0) {
        const ssize_t sent = ::send(to, bytes, count, MSG_NOSIGNAL);
        if (sent <= 0) return false;
        bytes += sent, count -= static_cast<std::size_t>(sent);
    }
    return true;
}

/// The number of received bytes; 0 at the end.
std::size_t receive(int from, std::array<char, 65536>& bytes) {
    const ssize_t count = ::recv(from, bytes.data(), bytes.size(), 0);
    return count > 0 ? static_cast<std::size_t>(count) : 0;
}

}  // namespace

CutLine::CutLine(int port) : server_port_(port), listening_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address = loopback(0);
    socklen_t size = sizeof address;
    if (::bind(listening_, reinterpret_cast<sockaddr*>(&address), size) != 0 || ::listen(listening_, 64) != 0)
        throw std::runtime_error("no port to listen on");
    ::getsockname(listening_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    accepting_ = std::thread([this] { serve(); });
}

CutLine::~CutLine() {
    ending_ = true;
    ::shutdown(listening_, SHUT_RDWR);
    accepting_.join();
    for (std::thread& line : lines_) line.join();
    ::close(listening_);
}

void CutLine::cut(std::int64_t number, When when) {
    when_ = when;
    messages_ = 0;
    cut_at_ = number;
}

void CutLine::serve() {
    for (;;) {
        const int client = ::accept(listening_, nullptr, nullptr);
        if (client < 0) return;
        const std::lock_guard lock(mutex_);
        lines_.emplace_back([this, client] { carry(client); });
    }
}

void CutLine::carry(int client) {
    const int server = ::socket(AF_INET, SOCK_STREAM, 0), on = 1;
    const sockaddr_in address = loopback(server_port_);
    ::setsockopt(client, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    ::setsockopt(server, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    bool open = ::connect(server, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
    std::array<char, 65536> bytes;
    while (open && !ending_) {
        std::array<pollfd, 2> ends{{{client, POLLIN, 0}, {server, POLLIN, 0}}};
        if (::poll(ends.data(), ends.size(), 100) <= 0) continue;
        if (ends[1].revents != 0) {
            const std::size_t count = receive(server, bytes);
            open = count > 0 && send_all(client, bytes.data(), count);
        }
        if (!open || ends[0].revents == 0) continue;
        const std::size_t count = receive(client, bytes);
        const bool cut = count > 0 && messages_.fetch_add(1) == cut_at_;
        if (cut && when_ == When::before) break;
        open = count > 0 && send_all(server, bytes.data(), count);
        if (!cut) continue;
        receive(server, bytes);  // the call has been executed
        break;
    }
    ::close(client);
    ::close(server);
}

}  // namespace tunewright::server
