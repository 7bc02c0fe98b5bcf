#include "server/notify/delivery_pool.h"

#include <algorithm>
#include <exception>
#include <system_error>

#include "server/log.h"

namespace tunewright::server {
namespace {

constexpr std::size_t kMaxRemembered = 1000;  ///< slow machines

}  // namespace

std::size_t DeliveryPool::room() const {
    const std::lock_guard lock(mutex_);
    return stopping_ ? 0 : kMaxWaiting - std::min(kMaxWaiting, waiting_.size());
}

std::size_t DeliveryPool::size() const {
    const std::lock_guard lock(mutex_);
    return waiting_.size() + running_;
}

bool DeliveryPool::add(Task task) {
    const std::lock_guard lock(mutex_);
    if (stopping_ || waiting_.size() >= kMaxWaiting) return false;
    Machine& machine = machines_[task.machine];
    if (machine.slow && machine.waiting >= kMaxWaitingOfSlow) return false;
    machine.waiting++;
    waiting_.push_back(std::move(task));
    if (threads_.size() < std::min(kThreads, waiting_.size() + running_)) grow();
    changed_.notify_one();
    return true;
}

/// Starts another thread; if the system has none, the existing threads do the work, or it is offered again later.
void DeliveryPool::grow() {
    try {
        threads_.emplace_back([this] { work(); });
    } catch (const std::system_error& fault) {
        log_error(std::string("no thread for notifications: ") + fault.what());
    }
}

/// The first task that may run. Tasks that have waited too long are dropped on the way.
bool DeliveryPool::pick(Task& task) {
    const auto now = Clock::now();
    for (auto it = waiting_.begin(); it != waiting_.end();) {
        Machine& machine = machines_[it->machine];
        const bool late = it->latest < now;
        if (!late && machine.running >= kMaxPerMachine) {
            ++it;
            continue;
        }
        machine.waiting--;
        Task taken = std::move(*it);
        it = waiting_.erase(it);
        if (late) {
            forget_idle(taken.machine);
            continue;
        }
        machine.running++;
        running_++;
        task = std::move(taken);
        return true;
    }
    return false;
}

void DeliveryPool::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        Task task;
        changed_.wait(lock, [&] { return stopping_ || pick(task); });
        if (!task.run) return;
        lock.unlock();
        const auto begun = Clock::now();
        try {
            task.run();
        } catch (const std::exception& fault) {
            log_error(std::string("a notification failed: ") + fault.what());
        }
        const auto time = Clock::now() - begun;
        task.run = nullptr;
        lock.lock();
        took(task.machine, time);
        changed_.notify_all();
    }
}

void DeliveryPool::took(const std::string& name, Clock::duration time) {
    running_--;
    Machine& machine = machines_[name];
    machine.running--;
    machine.slow = time > kSlowTime;
    if (machine.slow) {
        for (auto it = waiting_.end(); machine.waiting > kMaxWaitingOfSlow && it != waiting_.begin();) {
            --it;
            if (it->machine != name) continue;
            it = waiting_.erase(it);
            machine.waiting--;
        }
    }
    forget_idle(name);
}

void DeliveryPool::forget_idle(const std::string& name) {
    const Machine& machine = machines_[name];
    const bool idle = machine.running == 0 && machine.waiting == 0;
    if (idle && (!machine.slow || machines_.size() > kMaxRemembered)) machines_.erase(name);
}

bool DeliveryPool::stop(std::chrono::milliseconds patience) {
    {
        std::unique_lock lock(mutex_);
        stopping_ = true;
        waiting_.clear();
        changed_.notify_all();
        if (!changed_.wait_for(lock, patience, [this] { return running_ == 0; })) return false;
    }
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
    return true;
}

}  // namespace tunewright::server
