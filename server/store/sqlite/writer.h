// The one thread that writes to the database. What is asked for while a transaction is being made durable goes into
// the next one together: one wait for the disk for many changes. Bulky changes (a batch's) have a lane of their own:
// each transaction takes one of them, so that they never hold the others up for long. What need not wait for the disk
// has another: it goes between two waits.
#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "server/store/store.h"

namespace tunewright::server {

class Connection;
class Reserve;

class SqliteWriter {
public:
    struct Change {
        /// Runs inside a transaction. May run twice (a group that failed is repeated one by one), so it overwrites
        /// whatever it reported before.
        std::function<void(Connection&)> apply;
        /// Runs after the commit, with the fault where there was one.
        std::function<void(std::optional<StoreFault>)> done;
        /// The commit waits for the disk. Without it the change survives a kill of the process, not of the machine.
        bool durable = true;
        /// Touches many rows. Bulky changes keep their order among themselves, as do durable ones, and the others.
        bool bulky = false;
        /// Of the texts that it stores.
        std::size_t bytes = 0;
        /// A new job needs room for its result too, so that it is refused while the disk has little left; what gives
        /// room back may use the reserve.
        enum class Kind { usual, job, gives_room } kind = Kind::usual;
    };

    SqliteWriter(Connection& connection, Reserve& reserve);
    /// Makes everything durable that was asked for, then joins.
    ~SqliteWriter();
    SqliteWriter(const SqliteWriter&) = delete;
    SqliteWriter& operator=(const SqliteWriter&) = delete;

    void submit(Change change);
    /// The same as the destructor, while whoever owns it can still be asked for more: what is reported at the end may
    /// ask for further changes.
    void stop();
    /// False from a change that failed until one of its size has worked, or there is room for it, or for half a minute
    /// none has failed: on a full disk what is small often fits still.
    bool healthy() const { return healthy_; }

private:
    void work();
    /// While nothing can be written and nobody asks: whether it can be again.
    void probe();
    bool stopping();
    /// Left empty when it is time to stop or to probe.
    void next_group(std::vector<Change>& group);
    void write_group(std::vector<Change>& group);
    std::optional<StoreFault> try_commit(std::vector<Change>& group, std::size_t first, std::size_t count);
    std::optional<StoreFault> commit_where_room(std::vector<Change>& group, std::size_t first, std::size_t count);
    std::optional<StoreFault> commit(std::vector<Change>& group, std::size_t first, std::size_t count);
    bool has_moved();
    bool is_scarce();
    void refill();
    void failed(const StoreFault& fault, std::size_t bytes);
    void worked(std::size_t bytes);
    bool has_room(std::size_t bytes);

    Connection& connection_;
    Reserve& reserve_;
    std::optional<bool> waits_for_disk_;  ///< how the connection is set, once it is
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Change> quick_;  ///< not durable, not bulky
    std::deque<Change> waiting_;
    std::deque<Change> bulky_;
    bool quick_went_ = false;  ///< the last group was of quick ones
    bool stopping_ = false;
    std::atomic<bool> healthy_ = true;
    std::size_t awaited_ = 0;  ///< bytes of the largest change that has found no room since it was healthy
    std::chrono::steady_clock::time_point failed_at_, refilled_at_;
    std::jthread thread_;
};

/// What an SQLite error means to us; `system_error` is the errno of the call that failed, if that is known.
StoreFault fault_of(const std::exception& error, int system_error = 0);

}  // namespace tunewright::server
