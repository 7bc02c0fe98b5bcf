#include "server/threads/timer.h"

namespace tunewright::server {

using std::chrono::steady_clock;

Timer::Timer() : thread_([this] { work(); }) {}

Timer::~Timer() { stop(); }

void Timer::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

Timer::Key Timer::after(std::chrono::duration<double> delay, std::function<void()> action) {
    const auto time = steady_clock::now() + std::chrono::duration_cast<steady_clock::duration>(delay);
    const std::lock_guard lock(mutex_);
    const Key key{time, next_++};
    const auto place = actions_.emplace(key, std::move(action)).first;
    if (place == actions_.begin()) changed_.notify_one();
    return key;
}

void Timer::cancel(const Key& key) {
    const std::lock_guard lock(mutex_);
    actions_.erase(key);
}

void Timer::work() {
    std::unique_lock lock(mutex_);
    while (!stopping_) {
        if (actions_.empty()) {
            changed_.wait(lock);
        } else if (const auto time = actions_.begin()->first.first; time > steady_clock::now()) {
            changed_.wait_until(lock, time);
        } else {
            const auto action = std::move(actions_.begin()->second);
            actions_.erase(actions_.begin());
            lock.unlock();
            action();
            lock.lock();
        }
    }
}

}  // namespace tunewright::server
