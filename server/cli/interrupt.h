// Ctrl-C as a request to stop: what was computed until then is still the answer.
#pragma once

#include <stop_token>
#include <thread>

namespace tunewright::server {

/// Make it before other threads: they must not receive the signal. A second Ctrl-C ends the process.
class Interrupt {
public:
    Interrupt();
    ~Interrupt();
    Interrupt(const Interrupt&) = delete;
    Interrupt& operator=(const Interrupt&) = delete;

    std::stop_token token() const { return stop_.get_token(); }
    bool stopped() const { return stop_.stop_requested(); }

private:
    std::stop_source stop_;
    std::jthread watcher_;
};

/// The exit code of a process that was stopped by Ctrl-C.
inline constexpr int kInterrupted = 130;

}  // namespace tunewright::server
