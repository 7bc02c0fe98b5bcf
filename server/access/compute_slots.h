// Who computes while its client waits: so many at a time, clients in turn, so that one with many requests does not keep
// the others waiting, nor one whose requests take long.
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

class ComputeSlots {
public:
    using Clock = std::chrono::steady_clock;
    enum class Wait {
        granted,
        full,  ///< too many wait already
        late,  ///< the deadline has come before the turn
        left,  ///< the client has gone
    };

    /// At most `waiting` requests wait, of one client at most half of them. Beside those `at_once`, so many `more` are
    /// granted to clients that have no other under way: whoever fills all the places keeps nobody else from having one.
    ComputeSlots(std::size_t at_once, std::size_t more, std::size_t waiting)
        : at_once_(at_once), at_most_(at_once + more), max_waiting_(waiting) {}

    /// Waits for a turn; where it is granted, give_back() must follow. `left` is asked now and then.
    Wait take(const std::string& client, Clock::time_point deadline, const std::function<bool()>& left);
    void give_back(const std::string& client);
    std::size_t waiting() const;

private:
    struct Ticket {
        bool granted = false;
        std::condition_variable called;
    };
    bool may_begin(const std::string& client) const;
    void begin(const std::string& client);
    void grant();
    void withdraw(const std::string& client, Ticket& ticket);

    mutable std::mutex mutex_;
    const std::size_t at_once_, at_most_;
    const std::size_t max_waiting_;
    std::size_t under_way_ = 0;
    std::map<std::string, std::size_t> held_;  ///< of those under way, by client; none is 0
    std::size_t waiting_ = 0;
    std::map<std::string, std::deque<Ticket*>> queues_;  ///< none is empty
    std::list<std::string> order_;                       ///< of the clients with a queue
};

}  // namespace tunewright::server
