#include "server/http/guard/thread_pool.h"

#include <exception>
#include <string>
#include <system_error>
#include <thread>

#include "server/log.h"

namespace tunewright::server::http {
namespace {

constexpr std::chrono::seconds kMaxIdleTime{10};

void run_guarded(const std::function<void()>& task) {
    try {
        task();
    } catch (const std::exception& fault) {
        log_error(std::string("a thread of the server failed: ") + fault.what());
    }
}

}  // namespace

bool ThreadPool::stop_within(std::chrono::milliseconds patience) {
    std::unique_lock lock(mutex_);
    stopping_ = true;
    posted_.notify_all();
    return left_.wait_for(lock, patience, [this] { return threads_ == 0; });
}

bool ThreadPool::post(std::function<void()> task) {
    const std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
    if (idle_ >= tasks_.size()) return posted_.notify_one(), true;
    if (threads_ == max_) return true;
    try {
        std::thread([this] { work(); }).detach();
        threads_++;
        return true;
    } catch (const std::system_error&) {
        if (threads_ == 0) throw;
        return false;
    }
}

void ThreadPool::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        idle_++;
        const bool found = posted_.wait_for(lock, kMaxIdleTime, [this] { return stopping_ || !tasks_.empty(); });
        idle_--;
        if (tasks_.empty() && (stopping_ || !found)) break;
        const std::function<void()> task = std::move(tasks_.front());
        tasks_.pop_front();
        lock.unlock();
        run_guarded(task);
        lock.lock();
    }
    threads_--;
    // Requires the lock: the pool may be destroyed as soon as it is released.
    left_.notify_all();
}

}  // namespace tunewright::server::http
