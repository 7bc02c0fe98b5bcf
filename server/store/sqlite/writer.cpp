#include "server/store/sqlite/writer.h"

#include <sqlite3.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "server/log.h"
#include "server/store/sqlite/connection.h"

namespace tunewright::server {
namespace {

/// Keeps the time that one transaction holds the others up, and the log it writes, within bounds.
constexpr std::size_t kLargestGroup = 256;
constexpr std::chrono::milliseconds kProbePause{500};

}  // namespace

StoreFault fault_of(const std::exception& error, int system_error) {
    StoreFault fault{StoreFault::Kind::unavailable, error.what()};
    const auto* sqlite = dynamic_cast<const SQLite::Exception*>(&error);
    if (sqlite == nullptr) return fault;
    // SQLite reports a file that cannot grow in several ways: "full" of some limits, "I/O error" of others.
    const int code = sqlite->getErrorCode() & 0xff;
    const bool cannot_grow = system_error == ENOSPC || system_error == EDQUOT || system_error == EFBIG;
    if (code == SQLITE_FULL || (code == SQLITE_IOERR && cannot_grow))
        fault = {StoreFault::Kind::full, "the disk is full (" + fault.detail + ")"};
    return fault;
}

SqliteWriter::SqliteWriter(Connection& connection) : connection_(connection), thread_([this] { work(); }) {}

SqliteWriter::~SqliteWriter() { stop(); }

void SqliteWriter::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void SqliteWriter::submit(Change change) {
    {
        const std::lock_guard lock(mutex_);
        (change.bulky ? bulky_ : change.durable ? waiting_ : quick_).push_back(std::move(change));
    }
    changed_.notify_one();
}

std::vector<SqliteWriter::Change> SqliteWriter::next_group() {
    std::unique_lock lock(mutex_);
    const auto ready = [this] { return stopping_ || !quick_.empty() || !waiting_.empty() || !bulky_.empty(); };
    if (healthy_)
        changed_.wait(lock, ready);
    else
        changed_.wait_for(lock, kProbePause, ready);
    std::vector<Change> group;
    // What need not wait for the disk goes ahead, by itself: a claim that was put into a group with others would keep a
    // worker waiting for their results. Every other group is theirs, whatever comes.
    std::deque<Change>& first = !quick_.empty() && !std::exchange(quick_went_, true) ? quick_ : waiting_;
    if (&first == &waiting_) quick_went_ = false;
    std::deque<Change>& chosen = first.empty() && bulky_.empty() ? quick_ : first;
    while (!chosen.empty() && group.size() < kLargestGroup) {
        group.push_back(std::move(chosen.front()));
        chosen.pop_front();
    }
    if (&chosen == &waiting_ && !bulky_.empty()) {
        group.push_back(std::move(bulky_.front()));
        bulky_.pop_front();
    }
    return group;
}

void SqliteWriter::work() {
    for (;;) {
        std::vector<Change> group = next_group();
        if (!group.empty()) {
            write_group(group);
        } else if (stopping()) {
            return;
        } else {
            probe();
        }
    }
}

bool SqliteWriter::stopping() {
    const std::lock_guard lock(mutex_);
    return stopping_;
}

void SqliteWriter::probe() {
    // Writes a page, and leaves everything as it is.
    std::vector<Change> nothing(1);
    nothing[0].apply = [](Connection& store) {
        store.database().exec("PRAGMA user_version = " + std::to_string(store.number("PRAGMA user_version")));
    };
    healthy_ = !try_commit(nothing, 0, 1);
}

void SqliteWriter::write_group(std::vector<Change>& group) {
    if (!try_commit(group, 0, group.size())) {
        healthy_ = true;
        for (Change& change : group) change.done(std::nullopt);
        return;
    }
    // Somebody's change cannot be made: each alone, so that the others are not lost with it.
    for (std::size_t i = 0; i < group.size(); i++) {
        const std::optional<StoreFault> fault = try_commit(group, i, 1);
        healthy_ = !fault;
        if (fault) log_error("the store cannot write: " + fault->detail);
        group[i].done(fault);
    }
}

std::optional<StoreFault> SqliteWriter::try_commit(std::vector<Change>& group, std::size_t first, std::size_t count) {
    const auto begin = group.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = begin + static_cast<std::ptrdiff_t>(count);
    errno = 0;  // SQLite's own record of it does not outlive the rollback
    try {
        const bool durable = std::any_of(begin, end, [](const Change& change) { return change.durable; });
        if (durable != waits_for_disk_) {
            connection_.database().exec(durable ? "PRAGMA synchronous = FULL" : "PRAGMA synchronous = NORMAL");
            waits_for_disk_ = durable;
        }
        SQLite::Transaction transaction(connection_.database(), SQLite::TransactionBehavior::IMMEDIATE);
        for (auto change = begin; change != end; ++change) change->apply(connection_);
        transaction.commit();
        return std::nullopt;
    } catch (const std::exception& error) {
        return fault_of(error, errno);
    }
}

}  // namespace tunewright::server
