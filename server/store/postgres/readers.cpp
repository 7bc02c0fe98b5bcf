#include "server/store/postgres/readers.h"

#include <thread>

namespace tunewright::server::postgres {
namespace {

constexpr std::chrono::milliseconds kReconnectPause{100};  // after a failed attempt to connect

}  // namespace

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
        next_try_ = std::chrono::steady_clock::now() + kReconnectPause;
        throw;
    }
}

}  // namespace tunewright::server::postgres
