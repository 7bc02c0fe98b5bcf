// Detects a server that hangs while its machine still accepts data: no answer comes, and no error. A connection whose
// answer is overdue is cut, so that the waiting thread learns that it is lost.
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace tunewright::server::postgres {

/// The wait of one user of connections, which has one at a time.
class Line {
public:
    void asked(int socket);
    void answered();
    /// Time since the request that has no answer yet; 0 if there is none.
    std::chrono::milliseconds silence() const;
    /// Cuts the connection if the wait has lasted this long. Its user notices that and closes it.
    void cut_after(std::chrono::milliseconds patience);

private:
    using Clock = std::chrono::steady_clock;
    mutable std::mutex mutex_;
    std::optional<Clock::time_point> since_;
    int socket_ = -1;  ///< open during the wait for the answer
};

class Watch {
public:
    /// Longer than the server's own timeout of a statement: a live server has aborted it by then.
    static constexpr std::chrono::milliseconds kMaxStatementTime{15'000};

    Watch();
    ~Watch();
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;

    /// A line that is watched until its last reference is released.
    std::shared_ptr<Line> line();

private:
    void look();

    std::mutex mutex_;
    std::condition_variable stopped_;
    bool stopping_ = false;
    std::vector<std::weak_ptr<Line>> lines_;
    std::jthread thread_;
};

}  // namespace tunewright::server::postgres
