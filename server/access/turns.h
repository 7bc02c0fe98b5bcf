// Who computes while its client waits: so many at a time, clients in turn, so that one with many requests does not keep
// the others waiting.
#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <list>
#include <map>
#include <mutex>
#include <string>

namespace tunewright::server {

class Turns {
public:
    using Clock = std::chrono::steady_clock;
    enum class Wait {
        granted,
        full,  ///< too many wait already
        late,  ///< the deadline has come before the turn
        left,  ///< the client has gone
    };

    /// At most `waiting` requests wait, of one client at most half of them.
    Turns(std::size_t at_once, std::size_t waiting) : free_(at_once), most_waiting_(waiting) {}

    /// Waits for a turn; where it is granted, give_back() must follow. `left` is asked now and then.
    Wait take(const std::string& client, Clock::time_point deadline, const std::function<bool()>& left);
    void give_back();
    std::size_t waiting() const;

private:
    struct Ticket {
        bool granted = false;
        std::condition_variable called;
    };
    void grant();
    void withdraw(const std::string& client, Ticket& ticket);

    mutable std::mutex mutex_;
    std::size_t free_;
    const std::size_t most_waiting_;
    std::size_t waiting_ = 0;
    std::map<std::string, std::deque<Ticket*>> queues_;  ///< none is empty
    std::list<std::string> order_;                       ///< of the clients with a queue
};

}  // namespace tunewright::server
