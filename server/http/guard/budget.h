// The memory of requests until they are answered. Half of it is for requests that arrive: if they need more, one of
// them gives way. The other half is for requests that are being answered.
#pragma once

#include <chrono>
#include <condition_variable>
#include <functional>
#include <list>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

namespace tunewright::server::http {

class Budget {
    using Clock = std::chrono::steady_clock;

public:
    explicit Budget(std::size_t bytes) : max_(bytes) {}

private:
    struct Entry {
        std::string client;
        std::size_t bytes = 0;
        std::function<void()> give_way;                 ///< empty: its request has arrived completely and does not give
                                                        ///< way
        bool answering = false;                         ///< the request is being answered
        std::optional<Clock::time_point> leaving = {};  ///< time at which it was asked to give way
    };
    using EntryIterator = std::list<Entry>::iterator;
    struct Sum {
        std::size_t all = 0, small = 0;  ///< bytes of all requests, and of small ones
    };

public:
    /// A request's part of the budget; returned by the destructor.
    class Reservation {
    public:
        Reservation() = default;
        Reservation(Reservation&& other) noexcept { *this = std::move(other); }
        Reservation& operator=(Reservation&& other) noexcept {
            std::swap(budget_, other.budget_);
            std::swap(place_, other.place_);
            return *this;
        }
        ~Reservation() {
            if (budget_ != nullptr) budget_->close(place_);
        }
        /// Reserves this number of further bytes for a request that arrives. If there is no room it waits, while the
        /// largest arriving request of the client with the most bytes gives way; if that is the same client, only to a
        /// request of half its size or less. Small requests have room of their own, a quarter of the total. False if
        /// there was no room in time, or this request was asked to give way.
        bool grow(std::size_t bytes, std::chrono::milliseconds patience) {
            return budget_->grow(*place_, bytes, patience);
        }
        /// The request is complete and no longer gives way; it reserves this number of further bytes for its answer, in
        /// all at most half of the total: if only small requests are being answered, there is room for it. False if
        /// there was no room in time; its state is then unchanged.
        bool arrived(std::size_t more, std::chrono::milliseconds patience) {
            return budget_->arrived(*place_, more, patience);
        }
        /// Reduces the reservation to this number of bytes.
        void keep(std::size_t bytes) { budget_->keep(*place_, bytes); }

    private:
        friend class Budget;
        Reservation(Budget& budget, EntryIterator place) : budget_(&budget), place_(place) {}
        Budget* budget_ = nullptr;
        EntryIterator place_;
    };

    /// An empty share. `give_way` is called at most once, from any thread and under a lock: it may only notify the
    /// owner of the share.
    Reservation open(std::string client, std::function<void()> give_way);
    /// The sum over all requests.
    std::size_t taken() const;

private:
    bool grow(Entry& entry, std::size_t bytes, std::chrono::milliseconds patience);
    bool arrived(Entry& entry, std::size_t more, std::chrono::milliseconds patience);
    void keep(Entry& entry, std::size_t bytes);
    void set(Entry& entry, std::size_t bytes);
    void close(EntryIterator place);
    bool is_small(std::size_t bytes) const;
    bool fits(const Sum& sum, std::size_t own, std::size_t before) const;
    Entry* to_give_way(const std::string& client, std::size_t bytes);

    const std::size_t max_;
    mutable std::mutex mutex_;
    std::condition_variable freed_;
    std::list<Entry> entries_;
    Sum arriving_, answering_;
};

}  // namespace tunewright::server::http
