#include "server/threads/periodic_thread.h"

namespace tunewright::server {

PeriodicThread::PeriodicThread(std::function<std::chrono::milliseconds()> beat)
    : beat_(std::move(beat)), thread_([this](const std::stop_token& stop) { work(stop); }) {}

void PeriodicThread::wake() {
    {
        const std::lock_guard lock(mutex_);
        woken_ = true;
    }
    changed_.notify_all();
}

void PeriodicThread::stop() {
    thread_.request_stop();
    if (thread_.joinable()) thread_.join();
}

void PeriodicThread::work(const std::stop_token& stop) {
    while (!stop.stop_requested()) {
        const std::chrono::milliseconds pause = beat_();
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, stop, pause, [this] { return woken_; });
        woken_ = false;
    }
}

}  // namespace tunewright::server
