#include "server/store/postgres/readers.h"

#include <thread>

namespace tunewright::server::postgres {
namespace {

constexpr std::size_t kPlaces = 4;
constexpr std::chrono::seconds kPatience{5};
constexpr std::chrono::milliseconds kPause{100};  // after a try to connect that failed

}  // namespace

std::unique_ptr<Session> Readers::take(bool& fresh) {
    std::unique_lock lock(mutex_);
    if (!left_.wait_for(lock, kPatience, [this] { return busy_ < kPlaces; }))
        throw Failure(Failure::Kind::broken, "no connection for reading became free");
    busy_++;
    fresh = idle_.empty();
    if (fresh) return nullptr;
    std::unique_ptr<Session> session = std::move(idle_.back());
    idle_.pop_back();
    return session;
}

std::unique_ptr<Session> Readers::open() {
    std::chrono::steady_clock::time_point earliest;
    {
        const std::lock_guard lock(mutex_);
        earliest = next_try_;
    }
    std::this_thread::sleep_until(earliest);
    try {
        return std::make_unique<Session>(address_, watch_.line());
    } catch (const Failure&) {
        const std::lock_guard lock(mutex_);
        next_try_ = std::chrono::steady_clock::now() + kPause;
        throw;
    }
}

void Readers::give_back(std::unique_ptr<Session> session) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(session));
}

void Readers::forget_all() {
    const std::lock_guard lock(mutex_);
    idle_.clear();
}

void Readers::leave() {
    {
        const std::lock_guard lock(mutex_);
        busy_--;
    }
    left_.notify_one();
}

}  // namespace tunewright::server::postgres
