// A disk that fails when a test says so: SQLite's own file system with a counter in front of it.
#pragma once

#include <sqlite3.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>

namespace tunewright::server {

/// In front of SQLite's file system for as long as it lives, for every file that is opened then; one at a time.
class FaultyDisk {
public:
    enum class Fault {
        none,
        write,        ///< nothing is written
        short_write,  ///< half is written
        full,         ///< half is written, and there is no room for the rest
        sync,         ///< nothing is made durable
    };

    FaultyDisk();
    ~FaultyDisk();
    FaultyDisk(const FaultyDisk&) = delete;
    FaultyDisk& operator=(const FaultyDisk&) = delete;

    /// The call `number` (from 0) to write, shorten or make durable fails so; those that follow work again.
    void fail(std::int64_t number, Fault fault);
    /// Calls so far, since fail().
    std::int64_t calls() const { return calls_; }
    /// Called after each call that has made a file durable, on the thread that did it.
    void on_sync(std::function<void()> synced) { synced_ = std::move(synced); }

private:
    struct File;
    Fault next();

    static File* file_of(sqlite3_file* file);
    static int open(sqlite3_vfs* vfs, sqlite3_filename name, sqlite3_file* file, int flags, int* out);
    static int write(sqlite3_file* file, const void* bytes, int count, sqlite3_int64 at);
    static int truncate(sqlite3_file* file, sqlite3_int64 size);
    static int sync(sqlite3_file* file, int flags);

    static FaultyDisk* now_;
    sqlite3_vfs* real_;
    sqlite3_vfs own_;
    std::atomic<std::int64_t> calls_ = 0;
    std::atomic<std::int64_t> failing_ = -1;
    std::atomic<Fault> fault_ = Fault::none;
    std::function<void()> synced_;
};

}  // namespace tunewright::server
