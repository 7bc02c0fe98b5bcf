#include "server/store/postgres/watch.h"

#include <sys/socket.h>

#include <utility>

namespace tunewright::server::postgres {
namespace {

constexpr std::chrono::milliseconds kPollInterval{500};

}  // namespace

void Line::asked(int socket) {
    const std::lock_guard lock(mutex_);
    since_ = Clock::now();
    socket_ = socket;
}

void Line::answered() {
    const std::lock_guard lock(mutex_);
    since_.reset();
}

std::chrono::milliseconds Line::silence() const {
    const std::lock_guard lock(mutex_);
    if (!since_) return std::chrono::milliseconds(0);
    return std::chrono::duration_cast<std::chrono::milliseconds>(Clock::now() - *since_);
}

void Line::cut_after(std::chrono::milliseconds patience) {
    const std::lock_guard lock(mutex_);
    if (since_ && Clock::now() - *since_ > patience) ::shutdown(socket_, SHUT_RDWR);
}

Watch::Watch() : thread_([this] { look(); }) {}

Watch::~Watch() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    stopped_.notify_all();
}

std::shared_ptr<Line> Watch::line() {
    auto made = std::make_shared<Line>();
    const std::lock_guard lock(mutex_);
    lines_.push_back(made);
    return made;
}

void Watch::look() {
    std::unique_lock lock(mutex_);
    while (!stopped_.wait_for(lock, kPollInterval, [this] { return stopping_; })) {
        std::erase_if(lines_, [](const std::weak_ptr<Line>& line) { return line.expired(); });
        for (const std::weak_ptr<Line>& each : lines_)
            if (const std::shared_ptr<Line> line = each.lock()) line->cut_after(kMaxStatementTime);
    }
}

}  // namespace tunewright::server::postgres
