// Whether a client sends a streamed body fast enough. Only the time counts in which we wait for it.
#pragma once

#include <chrono>
#include <cstddef>

namespace tunewright::server::http {

class Pace {
public:
    using Time = std::chrono::steady_clock::time_point;

    Pace() = default;
    /// `bytes` must come in each `window` of waiting.
    Pace(std::size_t bytes, std::chrono::milliseconds window) : bytes_(bytes), window_(window), left_(window) {}

    /// We wait from now on. Again, while waiting, does nothing.
    void wait(Time now) {
        if (!waiting_) since_ = now;
        waiting_ = true;
    }
    /// Something has come, and for now we do not wait.
    void arrived(std::size_t bytes, Time now) {
        if (waiting_) left_ -= now - since_;
        waiting_ = false;
        come_ += bytes;
        if (come_ < bytes_) return;
        come_ = 0;
        left_ = window_;
    }
    bool waiting() const { return waiting_; }
    /// While waiting: when it has been too long.
    Time end() const { return since_ + std::chrono::duration_cast<Time::duration>(left_); }

private:
    std::size_t bytes_ = 0;
    Time::duration window_{};
    Time::duration left_{};
    Time since_{};
    std::size_t come_ = 0;
    bool waiting_ = false;
};

}  // namespace tunewright::server::http
