#include "server/http/guard/guard.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <thread>

#include "server/http/guard/exchange.h"
#include "server/http/guard/library.h"

namespace tunewright::server::http {
namespace {

constexpr int kBacklog = 1024;
constexpr std::chrono::milliseconds kStoppingInterval{10};
constexpr std::size_t kNetworkBytes = 8;  // of an IPv6 address: a customer gets a /64

sockaddr_storage peer_of(int fd) {
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    ::getpeername(fd, reinterpret_cast<sockaddr*>(&address), &size);
    return address;
}

std::string text_of(const sockaddr_storage& address) {
    std::array<char, INET6_ADDRSTRLEN> text{};
    if (address.ss_family == AF_INET)
        ::inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in&>(address).sin_addr, text.data(), text.size());
    else if (address.ss_family == AF_INET6)
        ::inet_ntop(AF_INET6, &reinterpret_cast<const sockaddr_in6&>(address).sin6_addr, text.data(), text.size());
    return text.data();
}

/// The network of a connection: the address, for IPv6 its first 64 bits.
std::string network_of(sockaddr_storage address) {
    if (address.ss_family != AF_INET6) return text_of(address);
    auto& bytes = reinterpret_cast<sockaddr_in6&>(address).sin6_addr.s6_addr;
    if (IN6_IS_ADDR_V4MAPPED(&reinterpret_cast<sockaddr_in6&>(address).sin6_addr)) return text_of(address);
    std::memset(bytes + kNetworkBytes, 0, sizeof bytes - kNetworkBytes);
    return text_of(address);
}

bool is_loopback(const std::string& address) {
    return address.starts_with("127.") || address.starts_with("::ffff:127.") || address == "::1" || address == "::";
}

}  // namespace

Server::Guard::Guard(const ServerLimits& limits, Application application)
    : limits_(limits),
      application_(std::move(application)),
      bodies_(limits.bodies),
      answers_(limits.unsent),
      crew_(limits.connections) {
    set_tcp_nodelay(true);
    // SO_REUSEADDR only: a port on which another process listens is an error, never shared.
    set_socket_options([](socket_t fd) {
        const int on = 1;
        ::setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    });
    set_payload_max_length(limits_.max_batch_body);
    set_pre_routing_handler([](const httplib::Request&, httplib::Response& out) { return Exchange::before_body(out); });
    const auto with_body = [](const httplib::Request&, httplib::Response& out, const httplib::ContentReader& body) {
        Exchange::with_body(out, body);
    };
    Post("/", with_body);
    Delete("/", with_body);
    set_post_routing_handler([](const httplib::Request&, httplib::Response& out) { Exchange::before_headers(out); });
}

Server::Guard::~Guard() {
    if (listener_ >= 0) ::close(listener_);
}

int Server::Guard::open(const std::string& host, int port) {
    errno = 0;
    if (!bind_to_port(host, port)) {
        const std::string where = host + ":" + std::to_string(port);
        if (errno == EADDRINUSE)
            throw std::runtime_error("Cannot listen on " + where +
                                     ": the port is taken by another process. Stop it or choose another --listen.");
        throw std::runtime_error("Cannot listen on " + where + ": " +
                                 (errno != 0 ? std::strerror(errno) : "the host name is not known") + ".");
    }
    // The library listens with a backlog of 5, which drops connections in bursts.
    ::listen(svr_sock_, kBacklog);
    listener_ = svr_sock_;
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    return ntohs(address.ss_family == AF_INET6 ? reinterpret_cast<sockaddr_in6&>(address).sin6_port
                                               : reinterpret_cast<sockaddr_in&>(address).sin_port);
}

/// Replaces the library's own loop, which ends at temporary errors, such as too many open files in the whole system.
void Server::Guard::serve() {
    while (!closed_) {
        const int socket = ::accept4(listener_, nullptr, nullptr, SOCK_CLOEXEC);
        if (socket >= 0)
            expect_one(socket);
        else if (errno != EINTR && errno != ECONNABORTED && !closed_)
            std::this_thread::sleep_for(kStoppingInterval);
    }
    finish_under_way();
}

void Server::Guard::close() {
    if (stopping_.exchange(true) || listener_ < 0) return;
    // Clients that are already connected are accepted first: closing the port would reset them.
    const auto end = std::chrono::steady_clock::now() + limits_.farewell;
    for (pollfd port{listener_, POLLIN, 0}; ::poll(&port, 1, 0) > 0 && std::chrono::steady_clock::now() < end;)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    // Ends accept(). The library's own stop() would cut off streams.
    closed_ = true;
    ::shutdown(listener_, SHUT_RDWR);
}

/// Requires the lock. True if one of the connections satisfies the condition.
template <class Which>
bool Server::Guard::any(const Which& which) const {
    return std::ranges::any_of(neighbours_, [&](const auto& item) { return std::ranges::any_of(item.second, which); });
}

/// After the port is closed: requests that are arriving get their answer, and those in progress the time `stopping`.
void Server::Guard::finish_under_way() {
    const auto start = std::chrono::steady_clock::now();
    const auto elapsed = [&] { return std::chrono::steady_clock::now() - start; };
    const auto busy = [&] {
        const std::lock_guard lock(mutex_);
        if (connections_ == 0 || elapsed() < limits_.farewell) return connections_ > 0;
        return any([](const Connection* connection) { return !connection->waiting || connection->begun; });
    };
    while (elapsed() < limits_.stopping && busy()) std::this_thread::sleep_for(kStoppingInterval);
    const std::lock_guard lock(mutex_);
    over_ = true;
    any([](const Connection* connection) { return connection->cut_off(), false; });
}

// ---- opening and closing of connections ----

/// Another connection is to be served. At the limit, a connection of the network with the most gives way.
void Server::Guard::expect_one(int socket) {
    {
        const std::lock_guard lock(mutex_);
        connections_++;
    }
    const bool has_thread = crew_.post([this, socket] { attend(socket); });
    const std::lock_guard lock(mutex_);
    starved_ = !has_thread;
    thin_out();
}

/// Requires the lock. The network with the most connections is known once every thread has a connection.
void Server::Guard::thin_out() {
    const std::size_t max = starved_ ? served_ : limits_.connections;
    if (neighbours_.empty() || connections_ - leaving_ <= max || served_ < max) return;
    make_room(std::ranges::max_element(neighbours_, {}, [](const auto& item) { return item.second.size(); })->second);
}

/// Cuts off the connection that has waited longest for its client. A client normally sends its head and its body
/// without delay, so its connections are rarely among these except between two requests.
bool Server::Guard::make_room(const Neighbours& among) {
    Connection* longest = nullptr;
    Connection::Clock::time_point since;
    for (Connection* connection : among) {
        const auto own = connection->leaving ? std::nullopt : connection->waiting_since();
        if (own && (longest == nullptr || *own < since)) longest = connection, since = *own;
    }
    if (longest == nullptr) return false;
    longest->leaving = true;
    leaving_++;
    longest->cut_off();
    return true;
}

/// False if its network has the maximum number of connections and none of them gives way.
bool Server::Guard::enter(Connection& connection) {
    const std::lock_guard lock(mutex_);
    Neighbours& all = neighbours_[connection.network];
    const bool limited = !limits_.behind_proxy && !is_loopback(connection.address);
    const bool allowed = !limited || all.size() < limits_.of_one_network || make_room(all);
    all.insert(&connection);
    served_++;
    // More connections may have arrived than could give way. They wait for a thread; now that this connection has one,
    // another one may have to give way.
    thin_out();
    return allowed && !over_;
}

void Server::Guard::leave(Connection& connection) {
    const std::lock_guard lock(mutex_);
    connections_--;
    served_--;
    if (connection.leaving) leaving_--;
    const auto all = neighbours_.find(connection.network);
    all->second.erase(&connection);
    if (all->second.empty()) neighbours_.erase(all);
}

Occupancy Server::Guard::occupancy() const {
    const std::lock_guard lock(mutex_);
    return {.connections = connections_, .body_bytes = bodies_.taken(), .unsent_bytes = answers_.bytes()};
}

/// On a thread of the pool: all requests of a connection.
void Server::Guard::attend(int socket) {
    const sockaddr_storage peer = peer_of(socket);
    Connection connection(socket, text_of(peer), network_of(peer), limits_);
    const bool allowed = enter(connection);
    const std::shared_ptr<void> leaving(nullptr, [&](void*) { leave(connection); });
    while (allowed && converse(connection)) {
    }
}

/// One request and its answer; false if it was the last.
bool Server::Guard::converse(Connection& connection) {
    const std::optional<Head> head = connection.next_head();
    if (!head) return false;
    Exchange exchange(connection, *head, application_, limits_, bodies_, answers_, stopping_);
    const bool goes_on = exchange.run(
        [this](httplib::Stream& stream) { return process(*this, &Guard::process_request, stream, Exchange::on_head); });
    if (!goes_on) connection.linger();
    return goes_on;
}

// ---- public interface ----

Server::Server(const ServerLimits& limits, Application application)
    : guard_(std::make_unique<Guard>(limits, std::move(application))) {}

Server::~Server() = default;

int Server::listen(const std::string& host, int port) { return guard_->open(host, port); }

void Server::run() { guard_->serve(); }

Occupancy Server::occupancy() const { return guard_->occupancy(); }

void Server::stop() { guard_->close(); }

bool Server::idle_within(std::chrono::milliseconds patience) { return guard_->idle_within(patience); }

}  // namespace tunewright::server::http
