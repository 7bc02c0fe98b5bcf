// The memory of answers until their clients have read them: one total, and the choice of the answer that is dropped if
// the total is too large.
#pragma once

#include <chrono>
#include <condition_variable>
#include <list>
#include <mutex>
#include <utility>

#include "server/http/guard/connection.h"

namespace tunewright::server::http {

class UnsentResponses {
public:
    explicit UnsentResponses(std::size_t max) : max_(max) {}

private:
    struct Entry {
        Connection* connection;
        std::size_t bytes;
        bool sending = false;  ///< there was room for it
        bool leaving = false;  ///< its connection was cut off
    };
    using EntryIterator = std::list<Entry>::iterator;

public:
    /// Reserved bytes; returned by the destructor.
    class Reservation {
    public:
        Reservation() = default;
        Reservation(Reservation&& other) noexcept { *this = std::move(other); }
        Reservation& operator=(Reservation&& other) noexcept {
            std::swap(answers_, other.answers_);
            std::swap(place_, other.place_);
            return *this;
        }
        ~Reservation() {
            if (answers_ != nullptr) answers_->give_back(place_);
        }

    private:
        friend class UnsentResponses;
        Reservation(UnsentResponses& answers, EntryIterator place) : answers_(&answers), place_(place) {}
        UnsentResponses* answers_ = nullptr;
        EntryIterator place_;
    };

    /// Reserves bytes for the connection, and waits until there is room: clients that have read nothing for a moment
    /// are cut off, the oldest requests first, as many as necessary. If all clients read, the oldest requests are cut
    /// off after a while. Small answers do not count.
    Reservation hold(Connection& connection, std::size_t bytes);
    std::size_t bytes() const;

private:
    void give_back(EntryIterator place);
    void make_room(std::unique_lock<std::mutex>& lock, const Entry& own);
    Entry* oldest(Connection::Clock::time_point moved_before);

    const std::size_t max_;
    mutable std::mutex mutex_;
    std::condition_variable freed_;
    std::list<Entry> entries_;
    std::size_t sum_ = 0;      ///< bytes of all answers
    std::size_t leaving_ = 0;  ///< bytes of those that were cut off
};

}  // namespace tunewright::server::http
