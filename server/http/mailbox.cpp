#include "server/http/mailbox.h"

#include <sys/eventfd.h>
#include <unistd.h>

#include <utility>

namespace tunewright::server::http {

Mailbox::Mailbox() : event_(::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)) {}

Mailbox::~Mailbox() { ::close(event_); }

template <class Add>
bool Mailbox::add(const Add& how) {
    bool first = false;
    {
        const std::lock_guard lock(mutex_);
        if (closed_) return false;
        first = std::exchange(empty_, false) && std::this_thread::get_id() != loop_;
        how(mail_);
    }
    if (first) wake();
    return true;
}

bool Mailbox::put(Address to, Response response) {
    return add([&](Mail& mail) { mail.answers.push_back({to, std::move(response)}); });
}

bool Mailbox::nudge(Address to) {
    return add([&](Mail& mail) { mail.nudges.push_back(to); });
}

bool Mailbox::run(std::function<void()> task) {
    return add([&](Mail& mail) { mail.tasks.push_back(std::move(task)); });
}

void Mailbox::open() {
    const std::lock_guard lock(mutex_);
    loop_ = std::this_thread::get_id();
}

Mailbox::Mail Mailbox::take() {
    const std::lock_guard lock(mutex_);
    empty_ = true;
    return std::exchange(mail_, {});
}

bool Mailbox::empty() const {
    const std::lock_guard lock(mutex_);
    return empty_;
}

void Mailbox::close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
}

void Mailbox::wake() const {
    const std::uint64_t one = 1;
    [[maybe_unused]] const ssize_t n = ::write(event_, &one, sizeof one);
}

void Mailbox::clear_wake() const {
    std::uint64_t count = 0;
    [[maybe_unused]] const ssize_t n = ::read(event_, &count, sizeof count);
}

}  // namespace tunewright::server::http
