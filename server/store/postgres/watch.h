// A server that hangs while its machine still takes what is sent to it: no answer comes, and no error. A connection
// whose answer does not come is cut, so that whoever waits for it learns that it is lost.
#pragma once

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace tunewright::server::postgres {

/// What one user of connections, which has one at a time, waits for.
class Line {
public:
    void asked(int socket);
    void answered();
    /// How long the answer has been waited for; 0 where none is.
    std::chrono::milliseconds silence() const;
    /// Cuts the connection where that has been so long. Its user notices, and closes it.
    void cut_after(std::chrono::milliseconds patience);

private:
    using Clock = std::chrono::steady_clock;
    mutable std::mutex mutex_;
    std::optional<Clock::time_point> since_;
    int socket_ = -1;  ///< open as long as the answer is waited for
};

class Watch {
public:
    /// Longer than the server lets any statement take: one that is alive has refused it by then.
    static constexpr std::chrono::milliseconds kMaxStatementTime{15'000};

    Watch();
    ~Watch();
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;

    /// A line that is watched until nobody has it any more.
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
