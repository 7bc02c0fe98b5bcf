// The one thread that writes to the database. Changes that arrive while a transaction is being made durable are
// combined in the next one: one wait for the disk for many changes. Bulky changes (of a batch) have a queue of their
// own: each transaction takes one of them, so that they never delay the others for long. Changes that need not wait for
// the disk have another queue: they run between two waits. Changes for which nobody waits gather for some milliseconds,
// because a transaction costs as much as several of them.
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
        /// Runs inside a transaction. May run twice (a group that failed is repeated one by one), so it must overwrite
        /// its earlier output.
        std::function<void(Connection&)> apply;
        /// Runs after the commit, with the fault if there was one.
        std::function<void(std::optional<StoreFault>)> done;
        /// The commit waits for the disk. Otherwise the change survives a kill of the process, but not a failure of the
        /// machine.
        bool durable = true;
        /// Changes many rows. Bulky changes keep their order among themselves, as do durable ones, and the others.
        bool bulky = false;
        /// Nobody waits for it: it may gather with others before it is written.
        bool patient = false;
        /// Length of the texts that it stores.
        std::size_t bytes = 0;
        /// A new job also needs space for its result, so it is refused while the disk has little left; a change that
        /// frees space may use the reserve.
        enum class Kind { usual, job, gives_room } kind = Kind::usual;
    };

    SqliteWriter(Connection& connection, Reserve& reserve);
    /// Makes all queued changes durable, then joins.
    ~SqliteWriter();
    SqliteWriter(const SqliteWriter&) = delete;
    SqliteWriter& operator=(const SqliteWriter&) = delete;

    void submit(Change change);
    /// Like the destructor, but before the owner is destroyed: the last callbacks may queue further changes.
    void stop();
    /// False from a change that failed until one of its size has succeeded, or there is space for it, or no change has
    /// failed for half a minute: on a full disk small changes often still succeed.
    bool healthy() const { return healthy_; }

private:
    void work();
    /// While writes fail and no change arrives: checks whether writing is possible again.
    void probe();
    bool stopping();
    /// Empty when it is time to stop or to probe.
    void next_group(std::vector<Change>& group);
    void await_changes(std::unique_lock<std::mutex>& lock);
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
    std::optional<bool> waits_for_disk_;  ///< the current mode of the connection, once it is set
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Change> quick_;  ///< not durable, not bulky
    std::deque<Change> waiting_;
    std::deque<Change> bulky_;
    std::deque<Change> patient_;                           ///< durable, not yet among the waiting ones
    std::chrono::steady_clock::time_point patient_since_;  ///< arrival of the first of them
    bool quick_went_ = false;                              ///< the last group consisted of quick changes
    bool stopping_ = false;
    std::atomic<bool> healthy_ = true;
    std::size_t awaited_ = 0;  ///< bytes of the largest change that found no space since the store was last healthy
    std::chrono::steady_clock::time_point failed_at_, refilled_at_;
    std::jthread thread_;
};

/// The fault for an SQLite error; `system_error` is the errno of the failed call, if it is known.
StoreFault fault_of(const std::exception& error, int system_error = 0);

}  // namespace tunewright::server
