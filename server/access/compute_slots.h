// Slots for computations whose client waits: a limited number at a time, clients in turn, so that a client with many or
// with long requests does not keep others waiting.
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
        full,  ///< the queue is full
        late,  ///< the deadline came before the turn
        left,  ///< the client has disconnected
    };

    /// At most `waiting` requests wait, of one client at most half of them. In addition to `at_once`, `more` slots are
    /// granted to clients that have no other request in progress, so that a client that fills all slots does not block
    /// the others.
    ComputeSlots(std::size_t at_once, std::size_t more, std::size_t waiting)
        : at_once_(at_once), at_most_(at_once + more), max_waiting_(waiting) {}

    /// Waits for a turn; if it is granted, give_back() must follow. `left` is called from time to time.
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
    std::map<std::string, std::size_t> held_;  ///< number of requests in progress, by client; none is 0
    std::size_t waiting_ = 0;
    std::map<std::string, std::deque<Ticket*>> queues_;  ///< none is empty
    std::list<std::string> order_;                       ///< clients with a queue, in their order
};

}  // namespace tunewright::server
