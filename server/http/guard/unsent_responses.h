// The memory that answers take until their clients have taken them: one sum, and who gives way where it is too much.
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
        bool leaving = false;  ///< its connection has been cut off
    };
    using EntryIterator = std::list<Entry>::iterator;

public:
    /// Bytes that are held; given back when it goes.
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

    /// Counts what is held for the connection, and waits until there is room for it: clients that have taken nothing
    /// for a moment are cut off, those first whose requests are the oldest, as many as it takes. Where all take
    /// something, the oldest go after a while. What is small does not count.
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
    std::size_t sum_ = 0;      ///< of all
    std::size_t leaving_ = 0;  ///< of those that have been cut off
};

}  // namespace tunewright::server::http
