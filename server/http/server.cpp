#include "server/http/server.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

namespace tunewright::server::http {
namespace {

constexpr std::uint64_t kListener = 0;
constexpr std::uint64_t kMailbox = 1;
constexpr std::chrono::milliseconds kSweepInterval{250};
constexpr std::size_t kLingerAllowance = 256 * 1024;
constexpr std::size_t kLingerBodyMost = 64 * 1024 * 1024;

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

/// Answers on their way from other threads to the loop. Outlives the loop for as long as somebody holds a Reply.
class Server::Mailbox {
public:
    struct Answer {
        Id id;
        std::uint64_t ticket;
        Response response;
    };

    Mailbox() : event_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}
    ~Mailbox() { ::close(event_); }
    Mailbox(const Mailbox&) = delete;
    Mailbox& operator=(const Mailbox&) = delete;

    void put(Id id, std::uint64_t ticket, Response response) {
        bool first = false;
        {
            const std::lock_guard lock(mutex_);
            first = answers_.empty();
            answers_.push_back({id, ticket, std::move(response)});
        }
        if (first && std::this_thread::get_id() != loop) wake();
    }

    std::vector<Answer> take() {
        const std::lock_guard lock(mutex_);
        return std::exchange(answers_, {});
    }

    void wake() const {
        const std::uint64_t one = 1;
        [[maybe_unused]] const ssize_t n = ::write(event_, &one, sizeof one);
    }

    void clear_wake() const {
        std::uint64_t count = 0;
        [[maybe_unused]] const ssize_t n = ::read(event_, &count, sizeof count);
    }

    int event() const { return event_; }

    std::thread::id loop;

private:
    int event_;
    std::mutex mutex_;
    std::vector<Answer> answers_;
};

Server::Server(Limits limits, Handler handler, Refusal refusal)
    : limits_(limits),
      handler_(std::move(handler)),
      refusal_(std::move(refusal)),
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
    mailbox_->loop = std::this_thread::get_id();
    std::array<epoll_event, 256> events{};
    SteadyTime last_moment = SteadyTime::max();
    while (!(stopping_ && (!busy() || now_ > last_moment))) {
        const int n = ::epoll_wait(epoll_, events.data(), static_cast<int>(events.size()),
                                   static_cast<int>(kSweepInterval.count()));
        now_ = std::chrono::steady_clock::now();
        for (int i = 0; i < n; i++) on_event(events[i].data.u64, events[i].events);
        do {
            collect_answers();
            for (const Id id : std::exchange(ready_, {})) pump(id);
            collect_answers();
        } while (!ready_.empty());
        if (now_ >= next_sweep_) sweep();
        if (stopping_ && listener_open_) {
            listener_open_ = false;
            pause_accepting();
            last_moment = now_ + limits_.stopping;
        }
    }
    connections_.clear();
}

void Server::stop() {
    stopping_ = true;
    mailbox_->wake();
}

bool Server::busy() const {
    for (const auto& [id, connection] : connections_)
        if (connection->state == Connection::State::handling || connection->state == Connection::State::writing)
            return true;
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

bool Server::make_room() {
    if (connections_.size() < limits_.connections) return true;
    Id oldest = 0;
    SteadyTime since = SteadyTime::max();
    for (const auto& [id, connection] : connections_) {
        if (connection->idle() && connection->since < since) {
            oldest = id;
            since = connection->since;
        }
    }
    if (oldest != 0) drop(oldest);
    return oldest != 0;
}

void Server::accept_all() {
    for (;;) {
        if (!make_room()) return pause_accepting();
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
    if ((events & (EPOLLIN | EPOLLRDHUP)) != 0) connection.readable = true;
    if (connection.state == Connection::State::writing && (events & EPOLLOUT) != 0)
        flush(id, connection);
    else
        ready_.push_back(id);
}

void Server::pump(Id id) {
    const auto found = connections_.find(id);
    if (found == connections_.end()) return;
    Connection& connection = *found->second;
    if (connection.state == Connection::State::reading) {
        if (read_step(id, connection)) dispatch(id, connection);
    } else if (connection.state == Connection::State::lingering && connection.readable) {
        connection.readable = false;
        if (connection.discard() == Connection::Io::gone) drop(id);
    }
}

/// True when a whole request is in the buffer.
bool Server::read_step(Id id, Connection& connection) {
    const std::size_t before = connection.buffered();
    Connection::Io io = Connection::Io::done;
    connection.frame(limits_.body);
    if (!connection.request_complete() && connection.readable) io = connection.receive(limits_.body);
    buffered_ += connection.buffered() - before;
    if (io == Connection::Io::gone) {
        drop(id);
        return false;
    }
    const Head& head = connection.frame(limits_.body);
    if (head.state == Head::State::refused) {
        refuse(id, connection, head.status, head.detail);
        return false;
    }
    if (connection.request_complete()) return true;
    if (buffered_ > limits_.buffered) {
        refuse(id, connection, 503, "Too many unfinished requests are being received; try again in a moment.");
        return false;
    }
    // The clock of a request runs from its first byte, and once more for its body.
    if (connection.buffered() > 0 && before == 0) enter(connection, Connection::State::reading, limits_.head);
    if (head.state == Head::State::complete) {
        connection.deadline = connection.since + limits_.head + limits_.body_time;
        connection.send_continue();
    }
    return false;
}

void Server::dispatch(Id id, Connection& connection) {
    const Head head = connection.frame(limits_.body);
    const std::size_t before = connection.buffered();
    std::string body = connection.take_body();
    buffered_ -= before - connection.buffered();
    std::optional<Request> request = parser_.parse(head.clean);
    if (!request) return refuse(id, connection, 400, "The request line or a header field cannot be read.");

    request->body = std::move(body);
    request->remote_addr = connection.remote_addr();
    connection.ticket = next_ticket_++;
    enter(connection, Connection::State::handling, limits_.handling);
    const bool is_head = request->method == "HEAD";
    const bool keep_alive = head.keep_alive;
    handler_(std::move(*request),
             [mailbox = mailbox_, id, ticket = connection.ticket, is_head, keep_alive](Response response) {
                 response.body_omitted = is_head;
                 response.close = response.close || !keep_alive;
                 mailbox->put(id, ticket, std::move(response));
             });
}

void Server::collect_answers() {
    for (Mailbox::Answer& item : mailbox_->take()) {
        const auto found = connections_.find(item.id);
        if (found == connections_.end()) continue;
        Connection& connection = *found->second;
        if (connection.state == Connection::State::handling && connection.ticket == item.ticket)
            answer(item.id, connection, std::move(item.response));
    }
}

void Server::refuse(Id id, Connection& connection, int status, const std::string& detail) {
    Response response = refusal_(status, detail, connection.remote_addr());
    response.close = true;
    answer(id, connection, std::move(response));
}

void Server::answer(Id id, Connection& connection, Response response) {
    const bool keep_alive = !response.close && !stopping_;
    enter(connection, Connection::State::writing, limits_.writing);
    connection.start_answer(std::move(response), keep_alive);
    flush(id, connection);
}

void Server::flush(Id id, Connection& connection) {
    const Connection::Io io = connection.send();
    if (io == Connection::Io::again) return;
    if (io == Connection::Io::gone) return drop(id);
    if (connection.keeps_alive()) {
        enter(connection, Connection::State::reading, limits_.idle);
        if (connection.buffered() > 0) enter(connection, Connection::State::reading, limits_.head);
    } else {
        const std::size_t announced = connection.frame(limits_.body).content_length;
        buffered_ -= connection.buffered();
        connection.start_lingering(announced <= kLingerBodyMost ? std::max(announced, kLingerAllowance)
                                                                : kLingerAllowance);
        enter(connection, Connection::State::lingering, limits_.lingering);
        connection.readable = true;
    }
    ready_.push_back(id);
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
        else if (connection.state == Connection::State::handling)
            refuse(id, connection, 503, "No answer could be made in time; try again.");
        else
            drop(id);
    }
    if (listener_open_ && !accepting_ && connections_.size() < limits_.connections) resume_accepting();
}

}  // namespace tunewright::server::http
