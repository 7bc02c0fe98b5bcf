#include "server/threads/executor.h"

#include <sys/resource.h>
#include <unistd.h>

#include <exception>
#include <future>
#include <memory>
#include <string>

#include "server/log.h"

namespace tunewright::server {

void be_nice(int niceness) {
    // On Linux a thread has its own niceness, addressed by its thread id.
    if (niceness > 0) ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), niceness);
}

Executor::Executor(std::size_t threads, int niceness) {
    for (std::size_t i = 0; i < threads; i++)
        threads_.emplace_back([this, niceness] {
            be_nice(niceness);
            work();
        });
}

Executor::~Executor() { stop(); }

void Executor::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    threads_.clear();
}

bool Executor::post(std::function<void()> task) {
    {
        const std::lock_guard lock(mutex_);
        if (stopping_) return false;
        tasks_.push_back(std::move(task));
    }
    changed_.notify_one();
    return true;
}

bool Executor::run(std::function<void()> task) {
    const auto packed = std::make_shared<std::packaged_task<void()>>(std::move(task));
    if (!post([packed] { (*packed)(); })) return false;
    packed->get_future().get();
    return true;
}

std::size_t Executor::waiting() const {
    const std::lock_guard lock(mutex_);
    return tasks_.size();
}

void Executor::work() {
    for (;;) {
        std::function<void()> task;
        {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [this] { return stopping_ || !tasks_.empty(); });
            if (tasks_.empty()) return;
            task = std::move(tasks_.front());
            tasks_.pop_front();
        }
        try {
            task();
        } catch (const std::exception& fault) {
            log_error(std::string("a task failed by an internal error: ") + fault.what());
        }
    }
}

}  // namespace tunewright::server
