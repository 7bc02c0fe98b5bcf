// A server with a handler of the test's own, and clients that send and read bytes as the test says.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdlib>
#include <future>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "server/http/problems.h"
#include "server/http/server.h"

namespace tunewright::server::http {

/// Serves from its own thread until it is stopped or destroyed.
class Loopback {
public:
    explicit Loopback(Handler handler, Limits limits = {}, StreamsBody streams = {})
        : server_(
              limits, std::move(handler),
              [](int status, const std::string& detail, const std::string&) {
                  return problem_response(status, detail);
              },
              std::move(streams)),
          port_(server_.listen("127.0.0.1", 0)),
          loop_([this] { server_.run(); }) {}
    ~Loopback() { stop(); }
    Loopback(const Loopback&) = delete;
    Loopback& operator=(const Loopback&) = delete;

    int port() const { return port_; }
    void ask_to_stop() { server_.stop(); }
    void stop() {
        server_.stop();
        if (loop_.joinable()) loop_.join();
    }

private:
    Server server_;
    int port_;
    std::jthread loop_;
};

/// A blocking socket. Each wait ends after 20 s: a test that hangs fails instead.
class Client {
public:
    explicit Client(const Loopback& server, int receive_buffer = 0) : fd_(::socket(AF_INET, SOCK_STREAM, 0)) {
        timeval patience{20, 0};
        ::setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
        ::setsockopt(fd_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
        if (receive_buffer > 0) ::setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_port = htons(static_cast<std::uint16_t>(server.port()));
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        if (::connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) std::abort();
    }
    ~Client() { close(); }
    Client(const Client&) = delete;
    Client& operator=(const Client&) = delete;

    void close() {
        if (fd_ >= 0) ::close(std::exchange(fd_, -1));
    }

    bool send(std::string_view bytes) {
        while (!bytes.empty()) {
            const ssize_t n = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
            if (n <= 0) return false;
            bytes.remove_prefix(static_cast<std::size_t>(n));
        }
        return true;
    }

    /// What has come up to and with `end`; shorter where the server closes before.
    std::string read_to(std::string_view end) {
        std::size_t at = 0;
        while ((at = pending_.find(end)) == std::string::npos)
            if (!receive()) return std::exchange(pending_, {});
        std::string found = pending_.substr(0, at + end.size());
        pending_.erase(0, found.size());
        return found;
    }

    /// All that comes until the server closes.
    std::string read_all() {
        while (receive()) {
        }
        return std::exchange(pending_, {});
    }

private:
    bool receive() {
        char buffer[65536];
        const ssize_t n = ::recv(fd_, buffer, sizeof buffer, 0);
        if (n > 0) pending_.append(buffer, static_cast<std::size_t>(n));
        return n > 0;
    }

    int fd_;
    std::string pending_;
};

inline std::string get(const std::string& target, const std::string& fields = "") {
    return "GET " + target + " HTTP/1.1\r\nHost: x\r\n" + fields + "\r\n";
}

}  // namespace tunewright::server::http
