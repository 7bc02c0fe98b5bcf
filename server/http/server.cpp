#include "server/http/server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <stdexcept>
#include <utility>

namespace tunewright::server::http {
namespace {

constexpr std::uint64_t kListener = 0;
constexpr std::uint64_t kMailbox = 1;
constexpr std::chrono::milliseconds kSweepInterval{250};
constexpr std::chrono::milliseconds kStoppingInterval{10};
constexpr int kRounds = 16;

void watch(int epoll, int fd, std::uint64_t id, std::uint32_t events) {
    epoll_event event{};
    event.events = events;
    event.data.u64 = id;
    ::epoll_ctl(epoll, EPOLL_CTL_ADD, fd, &event);
}

std::string address_text(const sockaddr_storage& address) {
    std::array<char, INET6_ADDRSTRLEN> text{};
    if (address.ss_family == AF_INET)
        ::inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in&>(address).sin_addr, text.data(), text.size());
    else if (address.ss_family == AF_INET6)
        ::inet_ntop(AF_INET6, &reinterpret_cast<const sockaddr_in6&>(address).sin6_addr, text.data(), text.size());
    return text.data();
}

}  // namespace

Server::Server(Limits limits, Handler handler, Refusal refusal, StreamsBody streams)
    : limits_(limits),
      handler_(std::move(handler)),
      refusal_(std::move(refusal)),
      streams_(std::move(streams)),
      mailbox_(std::make_shared<Mailbox>()),
      epoll_(::epoll_create1(EPOLL_CLOEXEC)) {
    if (epoll_ < 0 || mailbox_->event() < 0) throw std::runtime_error("Cannot create the event loop: out of files.");
    watch(epoll_, mailbox_->event(), kMailbox, EPOLLIN);
}

Server::~Server() {
    connections_.clear();
    ::close(epoll_);
}

int Server::listen(const std::string& host, int port) {
    listener_ = parser_.listen(host, port);
    resume_accepting();
    sockaddr_storage address{};
    socklen_t size = sizeof address;
    ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    return ntohs(address.ss_family == AF_INET6 ? reinterpret_cast<sockaddr_in6&>(address).sin6_port
                                               : reinterpret_cast<sockaddr_in&>(address).sin_port);
}

void Server::run() {
    mailbox_->open();
    std::array<epoll_event, 256> events{};
    while (!(stopping_ && !listener_open_ && (!busy() || now_ > last_moment_))) {
        const bool work_left = !ready_.empty() || !mailbox_->empty();
        const auto pause = work_left ? std::chrono::milliseconds{0} : stopping_ ? kStoppingInterval : kSweepInterval;
        const int n =
            ::epoll_wait(epoll_, events.data(), static_cast<int>(events.size()), static_cast<int>(pause.count()));
        now_ = std::chrono::steady_clock::now();
        for (int i = 0; i < n; i++) on_event(events[i].data.u64, events[i].events);
        // Not until nothing is left: a stream whose producer and client are quick never ends.
        for (int round = 0; round < kRounds; round++) {
            collect();
            if (ready_.empty()) break;
            for (const Id id : std::exchange(ready_, {})) pump(id);
        }
        if (now_ >= next_sweep_) sweep();
        if (stopping_ && listener_open_) begin_stop();
    }
    finish();
}

void Server::stop() {
    stopping_ = true;
    mailbox_->wake();
}

void Server::begin_stop() {
    if (accepting_) accept_all();
    pause_accepting();
    listener_open_ = false;
    parser_.stop_listening();
    last_moment_ = now_ + limits_.stopping;
    farewell_end_ = now_ + limits_.farewell;
    for (const auto& [id, connection] : connections_) {
        if (connection->state != Connection::State::writing || !connection->out.endless()) continue;
        connection->out.end_stream();
        ready_.push_back(id);
    }
}

void Server::finish() {
    connections_.clear();
    mailbox_->close();
    const Mailbox::Mail rest = mailbox_->take();
    for (const Mailbox::Answer& late : rest.answers) Outgoing::abandon(late.response.stream, true);
    for (const auto& task : rest.tasks) task();
}

/// True while somebody waits for an answer, or may have sent a request that has not reached us yet.
bool Server::busy() const {
    using State = Connection::State;
    for (const auto& [id, connection] : connections_) {
        if (connection->state == State::handling || connection->state == State::writing) return true;
        if (connection->state == State::reading && (connection->buffered() > 0 || now_ < farewell_end_)) return true;
    }
    return false;
}

void Server::pause_accepting() {
    if (accepting_) ::epoll_ctl(epoll_, EPOLL_CTL_DEL, listener_, nullptr);
    accepting_ = false;
}

void Server::resume_accepting() {
    if (!accepting_) watch(epoll_, listener_, kListener, EPOLLIN);
    accepting_ = true;
}

/// Closes the longest idle connection, or else ends the oldest event stream: its client comes back by itself.
bool Server::make_room() {
    Id oldest = 0;
    bool oldest_idle = false;
    SteadyTime since = SteadyTime::max();
    for (const auto& [id, connection] : connections_) {
        const bool idle = connection->idle();
        const bool events = connection->state == Connection::State::writing && connection->out.endless();
        if ((!idle && !events) || (oldest_idle && !idle)) continue;
        if (idle == oldest_idle && connection->since >= since) continue;
        oldest = id;
        oldest_idle = idle;
        since = connection->since;
    }
    if (oldest == 0) return false;
    Connection& connection = *connections_.at(oldest);
    connection.out.end_stream();
    if (!oldest_idle) connection.send();
    drop(oldest);
    return true;
}

bool Server::somebody_knocks() const {
    pollfd knock{listener_, POLLIN, 0};
    return ::poll(&knock, 1, 0) > 0;
}

void Server::accept_all() {
    for (;;) {
        if (connections_.size() >= limits_.connections) {
            if (!somebody_knocks()) return;
            if (!make_room()) return pause_accepting();
        }
        sockaddr_storage address{};
        socklen_t size = sizeof address;
        const int fd = ::accept4(listener_, reinterpret_cast<sockaddr*>(&address), &size, SOCK_NONBLOCK | SOCK_CLOEXEC);
        if (fd < 0) {
            if (errno == EINTR || errno == ECONNABORTED) continue;
            // Out of file handles: try again at the next sweep instead of spinning.
            if (errno != EAGAIN && errno != EWOULDBLOCK) pause_accepting();
            return;
        }
        const int on = 1;
        ::setsockopt(fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
        const Id id = next_id_++;
        auto connection = std::make_unique<Connection>(fd, address_text(address));
        enter(*connection, Connection::State::reading, limits_.idle);
        connections_.emplace(id, std::move(connection));
        watch(epoll_, fd, id, EPOLLIN | EPOLLOUT | EPOLLRDHUP | EPOLLET);
    }
}

void Server::on_event(Id id, std::uint32_t events) {
    if (id == kListener) return accept_all();
    if (id == kMailbox) return mailbox_->clear_wake();
    const auto found = connections_.find(id);
    if (found == connections_.end()) return;
    Connection& connection = *found->second;
    if ((events & (EPOLLERR | EPOLLHUP)) != 0) return drop(id);
    if ((events & EPOLLRDHUP) != 0) connection.peer_closed = true;
    // Who still reads a stream keeps the connection open for it; otherwise nobody would notice that a client left.
    if (connection.peer_closed && connection.state == Connection::State::writing && connection.out.streams())
        return drop(id);
    if ((events & (EPOLLIN | EPOLLRDHUP)) != 0) connection.readable = true;
    if (connection.state == Connection::State::writing && (events & EPOLLOUT) != 0)
        flush(id, connection);
    else
        ready_.push_back(id);
}

void Server::collect() {
    Mailbox::Mail mail = mailbox_->take();
    for (Mailbox::Answer& item : mail.answers) {
        const auto found = connections_.find(item.to.connection);
        const bool in_time = found != connections_.end() && found->second->state == Connection::State::handling &&
                             found->second->ticket == item.to.ticket;
        if (in_time)
            answer(found->first, *found->second, std::move(item.response));
        else
            Outgoing::abandon(item.response.stream, true);
    }
    for (const Mailbox::Address& to : mail.nudges) {
        const auto found = connections_.find(to.connection);
        if (found != connections_.end() && found->second->ticket == to.ticket) ready_.push_back(found->first);
    }
    for (const auto& task : mail.tasks) task();
}

void Server::enter(Connection& connection, Connection::State state, std::chrono::milliseconds limit) {
    connection.state = state;
    connection.since = now_ == SteadyTime{} ? std::chrono::steady_clock::now() : now_;
    connection.deadline = connection.since + limit;
}

void Server::drop(Id id) {
    const auto found = connections_.find(id);
    if (found == connections_.end()) return;
    buffered_ -= found->second->buffered();
    connections_.erase(found);
}

void Server::sweep() {
    next_sweep_ = now_ + kSweepInterval;
    std::vector<Id> late;
    for (const auto& [id, connection] : connections_)
        if (connection->deadline <= now_) late.push_back(id);
    for (const Id id : late) {
        Connection& connection = *connections_.at(id);
        if (connection.state == Connection::State::reading && !connection.idle())
            refuse(id, connection, 408, "The request did not arrive in time.");
        else if (connection.state == Connection::State::handling && connection.incoming && connection.pace.waiting())
            refuse(id, connection, 408, "The body arrives too slowly.");
        else if (connection.state == Connection::State::handling)
            refuse(id, connection, 503, "No answer could be made in time; try again.");
        else
            drop(id);
    }
    shed_unsent();
    if (listener_open_ && !accepting_) resume_accepting();
}

void Server::shed_unsent() {
    struct Writing {
        SteadyTime since;
        Id id;
        std::size_t pending;
    };
    std::vector<Writing> all;
    std::size_t unsent = 0;
    for (const auto& [id, connection] : connections_) {
        if (connection->state != Connection::State::writing) continue;
        all.push_back({connection->since, id, connection->out.pending()});
        unsent += all.back().pending;
    }
    if (unsent <= limits_.unsent) return;
    std::ranges::sort(all, {}, &Writing::since);
    for (const Writing& one : all) {
        if (unsent <= limits_.unsent) return;
        // An open stream on which nothing waits is old, but costs nothing.
        if (one.pending == 0) continue;
        unsent -= one.pending;
        drop(one.id);
    }
}

}  // namespace tunewright::server::http
