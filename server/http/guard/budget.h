// The memory that requests take until they are answered. Half of it is for requests that arrive: when they need more,
// one of them gives way. The other half is for requests that are being answered.
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
        std::function<void()> give_way;                 ///< empty: its request has arrived, and keeps what it holds
        bool answering = false;                         ///< counts among those that are being answered
        std::optional<Clock::time_point> leaving = {};  ///< since when it has been asked to give way
    };
    using EntryIterator = std::list<Entry>::iterator;
    struct Sum {
        std::size_t all = 0, small = 0;  ///< bytes, and those of small requests
    };

public:
    /// A request's part of the budget; given back when it goes.
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
        /// Holds so many bytes more of a request that arrives. Where they are too many it waits, while of the client
        /// that holds most in requests that arrive the largest gives way; if that is the same client, to one of half
        /// its size or less. Small requests have room of their own, a quarter of the whole. False where there was no
        /// room within the time, or this one has been asked to give way itself.
        bool grow(std::size_t bytes, std::chrono::milliseconds patience) {
            return budget_->grow(*place_, bytes, patience);
        }
        /// The request is whole and gives no way from now on; it holds so many bytes more while it is answered, in all
        /// at most half of the whole: where nothing else is being answered but small requests there is room for it.
        /// False where there was none within the time; then it counts as before.
        bool arrived(std::size_t more, std::chrono::milliseconds patience) {
            return budget_->arrived(*place_, more, patience);
        }
        /// Holds no more than so many bytes from now on.
        void keep(std::size_t bytes) { budget_->keep(*place_, bytes); }

    private:
        friend class Budget;
        Reservation(Budget& budget, EntryIterator place) : budget_(&budget), place_(place) {}
        Budget* budget_ = nullptr;
        EntryIterator place_;
    };

    /// A share of nothing yet. `give_way` is called once at most, from any thread and under a lock: it only tells the
    /// one whose share it is.
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
