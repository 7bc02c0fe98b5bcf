#include "server/store/sqlite/writer.h"

#include <fcntl.h>
#include <sqlite3.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <iterator>
#include <new>
#include <string>
#include <utility>

#include "server/log.h"
#include "server/store/sqlite/connection.h"
#include "server/store/sqlite/reserve.h"

namespace tunewright::server {
namespace {

/// Limits the time for which one transaction delays others, and the size of its log.
constexpr std::size_t kMaxGroup = 256;
constexpr std::size_t kSet = 32;  // patient changes that are enough for a transaction
constexpr std::chrono::milliseconds kPatience{20};
constexpr std::chrono::milliseconds kProbePause{500};
constexpr std::chrono::seconds kMinQuietTime{30};
constexpr std::chrono::milliseconds kShortWait{20};
constexpr std::chrono::seconds kFilePollInterval{1};  // of the check that the file still exists
constexpr std::size_t kRowBytes = 4096;               // bytes of a change without texts, at most
constexpr std::int64_t kMinFreePages = 256;           // of 4 KiB each, free within the file
const StoreFault kMoved{StoreFault::Kind::unavailable,
                        "its file was removed or replaced while it was open; put it back, or start again"};

/// Runs `work`; if memory is exhausted, the thread continues.
template <class Work>
void survive(Work work) {
    try {
        work();
    } catch (const std::bad_alloc&) {
    }
}

}  // namespace

StoreFault fault_of(const std::exception& error, int system_error) {
    StoreFault fault{StoreFault::Kind::unavailable, error.what()};
    const auto* sqlite = dynamic_cast<const SQLite::Exception*>(&error);
    if (sqlite == nullptr) return fault;
    // SQLite reports a file that cannot grow in several ways: some limits as "full", others as "I/O error".
    const int code = sqlite->getErrorCode() & 0xff;
    const bool cannot_grow = system_error == ENOSPC || system_error == EDQUOT || system_error == EFBIG;
    if (code == SQLITE_FULL || (code == SQLITE_IOERR && cannot_grow))
        fault = {StoreFault::Kind::full, "the disk is full (" + fault.detail + ")"};
    return fault;
}

SqliteWriter::SqliteWriter(Connection& connection, Reserve& reserve)
    : connection_(connection), reserve_(reserve), thread_([this] { work(); }) {}

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
    bool news = true;
    {
        const std::lock_guard lock(mutex_);
        if (change.patient) {
            if (patient_.empty()) patient_since_ = std::chrono::steady_clock::now();
            patient_.push_back(std::move(change));
            news = patient_.size() == 1 || patient_.size() >= kSet;
        } else {
            (change.bulky ? bulky_ : change.durable ? waiting_ : quick_).push_back(std::move(change));
        }
    }
    if (news) changed_.notify_one();
}

/// Returns with something to write, at the time for a probe, or to stop. Patient changes go with the first durable
/// ones, or after a while.
void SqliteWriter::await_changes(std::unique_lock<std::mutex>& lock) {
    const auto probe_at =
        std::chrono::steady_clock::now() + (healthy_ ? std::chrono::milliseconds(kFilePollInterval) : kProbePause);
    const auto due = [this] {
        return patient_.empty() ? std::chrono::steady_clock::time_point::max() : patient_since_ + kPatience;
    };
    const auto ripe = [&] {
        return !patient_.empty() &&
               (stopping_ || !waiting_.empty() || patient_.size() >= kSet || std::chrono::steady_clock::now() >= due());
    };
    while (!(stopping_ || !quick_.empty() || !waiting_.empty() || !bulky_.empty() || ripe()))
        if (changed_.wait_until(lock, std::min(probe_at, due())) == std::cv_status::timeout &&
            std::chrono::steady_clock::now() >= probe_at)
            break;
    if (!ripe()) return;
    std::ranges::move(patient_, std::back_inserter(waiting_));
    patient_.clear();
}

void SqliteWriter::next_group(std::vector<Change>& group) {
    std::unique_lock lock(mutex_);
    await_changes(lock);
    // Changes that need not wait for the disk go first and separately: a claim in a group with others would keep a
    // worker waiting for their results. Every second group is theirs.
    std::deque<Change>& first = !quick_.empty() && !std::exchange(quick_went_, true) ? quick_ : waiting_;
    if (&first == &waiting_) quick_went_ = false;
    std::deque<Change>& chosen = first.empty() && bulky_.empty() ? quick_ : first;
    while (!chosen.empty() && group.size() < kMaxGroup) {
        group.push_back(std::move(chosen.front()));
        chosen.pop_front();
    }
    if (&chosen == &waiting_ && !bulky_.empty()) {
        group.push_back(std::move(bulky_.front()));
        bulky_.pop_front();
    }
}

void SqliteWriter::work() {
    std::vector<Change> group;
    group.reserve(kMaxGroup + 1);  // reserved now, so that no change is lost if memory is exhausted
    for (;;) {
        next_group(group);
        if (group.empty() && stopping()) return;
        if (group.empty()) survive([this] { probe(); });
        write_group(group);
        group.clear();
        if (!healthy_ || !reserve_.filled()) survive([this] { refill(); });
    }
}

bool SqliteWriter::stopping() {
    const std::lock_guard lock(mutex_);
    return stopping_;
}

void SqliteWriter::probe() {
    if (has_moved()) return failed(kMoved, 0);
    if (healthy_) return;
    // Writes a page, and changes nothing.
    std::vector<Change> nothing(1);
    nothing[0].apply = [](Connection& store) {
        store.database().exec("PRAGMA user_version = " + std::to_string(store.number("PRAGMA user_version")));
    };
    if (try_commit(nothing, 0, 1)) return;
    worked(0);
}

/// True if the file system can allocate this number of bytes in addition; false if it cannot tell.
bool SqliteWriter::has_room(std::size_t bytes) {
    if (bytes == 0) return true;
    const std::string path = connection_.database().getFilename() + "-room";
    const int fd = ::open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    if (fd < 0) return false;
    // The text is written to the log of changes first, and then to the tables.
    const bool room = ::posix_fallocate(fd, 0, static_cast<off_t>(2 * bytes)) == 0;
    ::close(fd);
    ::unlink(path.c_str());
    return room;
}

void SqliteWriter::failed(const StoreFault& fault, std::size_t bytes) {
    failed_at_ = std::chrono::steady_clock::now();
    if (fault.kind == StoreFault::Kind::full) awaited_ = std::max(awaited_, bytes);
    if (healthy_.exchange(false)) log_error("the store cannot write: " + fault.detail);
}

void SqliteWriter::worked(std::size_t bytes) {
    if (healthy_ || is_scarce()) return;
    const bool quiet = std::chrono::steady_clock::now() - failed_at_ > kMinQuietTime;
    if (bytes < awaited_ && !quiet && !has_room(awaited_)) return;
    awaited_ = 0;
    healthy_ = true;
    log_info("the store can write again");
}

void SqliteWriter::write_group(std::vector<Change>& group) {
    if (group.empty()) return;
    const auto size_of = [](const Change& change) { return change.bytes + kRowBytes; };
    const auto answer = [](Change& change, const std::optional<StoreFault>& fault) {
        survive([&] { change.done(fault); });
    };
    const int rows = sqlite3_total_changes(connection_.database().getHandle());
    if (!try_commit(group, 0, group.size())) {
        std::size_t bytes = 0;
        for (const Change& change : group) bytes += size_of(change);
        if (sqlite3_total_changes(connection_.database().getHandle()) != rows) survive([&] { worked(bytes); });
        for (Change& change : group) answer(change, std::nullopt);
        return;
    }
    // One change fails: each is tried alone, so that the others are not lost with it.
    for (std::size_t i = 0; i < group.size(); i++) {
        const std::optional<StoreFault> fault = try_commit(group, i, 1);
        survive([&] { fault ? failed(*fault, size_of(group[i])) : worked(size_of(group[i])); });
        answer(group[i], fault);
    }
}

/// True if the path leads to another file, or to none: data written now would be lost with the process.
bool SqliteWriter::has_moved() {
    int moved = 0;
    const int asked = sqlite3_file_control(connection_.database().getHandle(), "main", SQLITE_FCNTL_HAS_MOVED, &moved);
    return asked == SQLITE_OK && moved != 0;
}

/// True if neither the disk nor the file itself has much space left.
bool SqliteWriter::is_scarce() {
    return reserve_.is_scarce() && connection_.number("PRAGMA freelist_count") < kMinFreePages;
}

/// Frees space on a full disk: the growth of the log of changes is returned to the disk, and the reserve is allocated
/// again. If the tables must grow for that, half of the reserve is used; another program may take that space first.
void SqliteWriter::refill() {
    const auto now = std::chrono::steady_clock::now();
    if (now - refilled_at_ < kProbePause) return;
    refilled_at_ = now;
    connection_.wait_for_others(kShortWait);
    const auto shorten_log = [this] { return connection_.database().tryExec("PRAGMA wal_checkpoint(TRUNCATE)"); };
    // Delayed while a reader is active.
    if (shorten_log() != SQLITE_OK && reserve_.release(false)) shorten_log();
    connection_.wait_for_others(kUsualWait);
    reserve_.fill();
}

std::optional<StoreFault> SqliteWriter::try_commit(std::vector<Change>& group, std::size_t first, std::size_t count) {
    try {
        return commit_where_room(group, first, count);
    } catch (const std::bad_alloc&) {
        return StoreFault{StoreFault::Kind::unavailable, "no memory"};
    }
}

std::optional<StoreFault> SqliteWriter::commit_where_room(std::vector<Change>& group, std::size_t first,
                                                          std::size_t count) {
    const auto begin = group.begin() + static_cast<std::ptrdiff_t>(first);
    const auto any = [&](Change::Kind kind) {
        return std::any_of(begin, begin + static_cast<std::ptrdiff_t>(count),
                           [kind](const Change& change) { return change.kind == kind; });
    };
    if (has_moved()) return kMoved;
    if (any(Change::Kind::job) && is_scarce()) {
        refill();
        if (is_scarce())
            return StoreFault{StoreFault::Kind::full,
                              "the disk is nearly full; the rest is reserved for existing jobs"};
    }
    auto fault = commit(group, first, count);
    if (!fault || fault->kind != StoreFault::Kind::full) return fault;
    refilled_at_ = {};  // immediately: the attempt has filled the log, and other programs would take the freed space
    if (count == 1 && any(Change::Kind::gives_room) && reserve_.release()) {
        if (healthy_) log_info("the disk of the store is full: the space reserved for deleting is released");
        fault = commit(group, first, count);
    }
    return fault;
}

std::optional<StoreFault> SqliteWriter::commit(std::vector<Change>& group, std::size_t first, std::size_t count) {
    const auto begin = group.begin() + static_cast<std::ptrdiff_t>(first);
    const auto end = begin + static_cast<std::ptrdiff_t>(count);
    errno = 0;  // SQLite's own record of it is lost by the rollback
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
