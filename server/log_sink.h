// The sink of the log's lines: a thread writes what has been collected, so that neither a slow reader nor a wake-up for
// each line delays the caller. If too many lines wait for the reader, the oldest are dropped.
#pragma once

#include <spdlog/sinks/base_sink.h>

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <deque>
#include <mutex>
#include <string>
#include <thread>

namespace tunewright::server {

class GatheringSink : public spdlog::sinks::base_sink<std::mutex> {
public:
    /// Writes lines to the open file `descriptor`; at most `max_waiting` wait for it.
    GatheringSink(int descriptor, std::size_t max_waiting);
    ~GatheringSink() override { stop(); }

    /// Writes the waiting lines; later ones are lost. By one thread at a time.
    void stop();

    std::size_t dropped() const { return dropped_; }

private:
    void sink_it_(const spdlog::details::log_msg& message) override;
    void flush_() override {}
    void work();

    const int descriptor_;
    const std::size_t max_waiting_;
    std::deque<std::string> waiting_;  // protected by base_sink's mutex_, like the rest
    bool stopping_ = false;
    std::condition_variable changed_;
    std::atomic<std::size_t> dropped_ = 0;
    std::thread thread_;
};

}  // namespace tunewright::server
