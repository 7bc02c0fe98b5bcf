#include "server/store/postgres/listener.h"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <array>

#include "server/store/postgres/notices.h"
#include "server/store/postgres/session.h"

namespace tunewright::server::postgres {
namespace {

constexpr int kFirstPauseMs = 100;
constexpr int kMaxPauseMs = 2000;

}  // namespace

Listener::Listener(Address address, std::string own_tag)
    : address_(std::move(address)),
      own_tag_(std::move(own_tag)),
      wake_(::eventfd(0, EFD_CLOEXEC)),
      thread_([this] { work(); }) {
    first_try_.wait();
}

Listener::~Listener() {
    stopping_ = true;
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t written = ::write(wake_, &one, sizeof one);
    thread_.join();
    ::close(wake_);
}

void Listener::watch(std::function<void(const StoreNotice&)> listener) {
    const std::lock_guard lock(mutex_);
    listener_ = std::move(listener);
}

void Listener::pass_on(const StoreNotice& notice) {
    const std::lock_guard lock(mutex_);
    if (listener_) listener_(notice);
}

bool Listener::pause(int milliseconds) {
    pollfd waited{wake_, POLLIN, 0};
    ::poll(&waited, 1, milliseconds);
    return !stopping_;
}

void Listener::tried() {
    if (!tried_) first_try_.count_down();
    tried_ = true;
}

void Listener::work() {
    int pause_ms = 0;
    while (!stopping_) {
        try {
            listen();
        } catch (const std::exception&) {  // the writers log the fault
            const bool first = connected_.exchange(false) || pause_ms == 0;
            pause_ms = first ? kFirstPauseMs : std::min(2 * pause_ms, kMaxPauseMs);
            tried();
            if (!pause(pause_ms)) return;
        }
    }
}

void Listener::listen() {
    const std::unique_ptr<Link> link = connect(address_);
    pqxx::connection& connection = link->connection;
    const Subscription subscription(connection, kChannel, [this](const std::string& payload) {
        read_payload(payload, own_tag_, [this](const StoreNotice& notice) { pass_on(notice); });
    });
    tried();
    if (!connected_.exchange(true)) {
        pass_on({StoreNotice::Kind::queued, ""});
        pass_on({StoreNotice::Kind::ended, ""});
    }
    while (!stopping_) {
        std::array<pollfd, 2> waited{{{connection.sock(), POLLIN, 0}, {wake_, POLLIN, 0}}};
        ::poll(waited.data(), waited.size(), -1);
        connection.get_notifs();
        if (!connection.is_open()) throw Failure(Failure::Kind::broken, "the connection was closed");
    }
}

}  // namespace tunewright::server::postgres
