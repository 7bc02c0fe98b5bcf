// A server with a handler of the test's own, and clients that send and read given bytes.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <cstdlib>
#include <functional>
#include <future>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>
#include <utility>

#include "server/http/app/problems.h"
#include "server/http/guard/server.h"

namespace tunewright::server::http {

/// Serves from its own thread until it is stopped or destroyed.
class Loopback {
public:
    explicit Loopback(std::function<Response(Request)> handle, ServerLimits limits = {},
                      std::function<bool(const Request&)> streams = {})
        : server_(limits, application(std::move(handle), std::move(streams))),
          port_(server_.listen("127.0.0.1", 0)),
          loop_([this] { server_.run(); }) {}
    ~Loopback() { stop(); }
    Loopback(const Loopback&) = delete;
    Loopback& operator=(const Loopback&) = delete;

    int port() const { return port_; }
    void ask_to_stop() { server_.stop(); }
    bool idle_within(std::chrono::milliseconds patience) { return server_.idle_within(patience); }
    void stop() {
        server_.stop();
        if (loop_.joinable()) loop_.join();
    }

private:
    static Application application(std::function<Response(Request)> handle,
                                   std::function<bool(const Request&)> streams) {
        Application made;
        made.handle = std::move(handle);
        made.streams = std::move(streams);
        made.refuse = [](int status, const std::string& detail, Request&) { return problem_response(status, detail); };
        return made;
    }

    Server server_;
    int port_;
    std::jthread loop_;
};

/// A blocking socket. Each wait ends after 20 s: a test that hangs fails instead.
class Client {
public:
    /// `from`: the last byte of the client's loopback address.
    explicit Client(const Loopback& server, int receive_buffer = 0, std::uint32_t from = 1)
        : fd_(::socket(AF_INET, SOCK_STREAM, 0)) {
        timeval patience{20, 0};
        ::setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
        ::setsockopt(fd_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
        if (receive_buffer > 0) ::setsockopt(fd_, SOL_SOCKET, SO_RCVBUF, &receive_buffer, sizeof receive_buffer);
        sockaddr_in address{};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl((INADDR_LOOPBACK & ~255U) | from);
        if (::bind(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) std::abort();
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

    /// The input up to and including `end`; shorter if the server closes before.
    std::string read_to(std::string_view end) {
        std::size_t at = 0;
        while ((at = pending_.find(end)) == std::string::npos)
            if (!receive()) return std::exchange(pending_, {});
        std::string found = pending_.substr(0, at + end.size());
        pending_.erase(0, found.size());
        return found;
    }

    /// All input until the server closes.
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

/// The body of an answer as controlled by the test: written pieces are sent when the client reads them.
class Dictation {
public:
    void write(std::string piece) { put(std::move(piece), End::no); }
    void end() { put({}, End::whole); }
    void break_off() { put({}, End::broken); }

    BodyProducer producer() {
        return [this](BodyWriter& out) { return dictate(out); };
    }
    /// Waits until the producer has ended; true if the reason was that the client had disconnected.
    bool client_left() { return left_.get_future().get(); }

private:
    enum class End { no, whole, broken };

    void put(std::string piece, End end) {
        const std::lock_guard lock(mutex_);
        written_ += piece;
        end_ = end;
        changed_.notify_all();
    }

    bool dictate(BodyWriter& out) {
        std::unique_lock lock(mutex_);
        for (;;) {
            changed_.wait_for(lock, std::chrono::milliseconds(20),
                              [this] { return !written_.empty() || end_ != End::no; });
            const std::string piece = std::exchange(written_, {});
            const End end = end_;
            lock.unlock();
            const bool gone = out.gone() || !out.write(piece);
            if (gone || end != End::no) {
                left_.set_value(gone);
                return !gone && end == End::whole;
            }
            lock.lock();
        }
    }

    std::mutex mutex_;
    std::condition_variable changed_;
    std::string written_;
    End end_ = End::no;
    std::promise<bool> left_;
};

inline std::string get(const std::string& target, const std::string& fields = "") {
    return "GET " + target + " HTTP/1.1\r\nHost: x\r\n" + fields + "\r\n";
}

}  // namespace tunewright::server::http
