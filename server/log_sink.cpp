#include "server/log_sink.h"

#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <utility>

namespace tunewright::server {
namespace {

constexpr std::chrono::milliseconds kGathering{5};

void write_all(int descriptor, const std::string& text) {
    for (std::size_t written = 0; written < text.size();) {
        const ssize_t count = ::write(descriptor, text.data() + written, text.size() - written);
        if (count < 0 && errno != EINTR) return;  // standard error is closed
        if (count > 0) written += static_cast<std::size_t>(count);
    }
}

}  // namespace

GatheringSink::GatheringSink(int descriptor, std::size_t max_waiting)
    : descriptor_(descriptor), max_waiting_(max_waiting), thread_([this] { work(); }) {}

void GatheringSink::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_one();
    if (thread_.joinable()) thread_.join();
}

void GatheringSink::sink_it_(const spdlog::details::log_msg& message) {
    if (stopping_) return;
    spdlog::memory_buf_t line;
    formatter_->format(message, line);
    if (waiting_.size() == max_waiting_) {
        waiting_.pop_front();
        ++dropped_;
    }
    waiting_.emplace_back(line.data(), line.size());
    if (waiting_.size() == 1) changed_.notify_one();
}

void GatheringSink::work() {
    std::unique_lock lock(mutex_);
    for (;;) {
        changed_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
        if (waiting_.empty()) return;
        // If there are many, the next lines come in a moment: they are collected without a wake-up for each.
        if (!stopping_) changed_.wait_for(lock, kGathering, [this] { return stopping_; });
        std::string text;
        for (const std::string& line : std::exchange(waiting_, {})) text += line;
        lock.unlock();
        write_all(descriptor_, text);
        lock.lock();
    }
}

}  // namespace tunewright::server
