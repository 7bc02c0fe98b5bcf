// A disk that fails when a test says so: SQLite's own file system with a counter in front of it.
#pragma once

#include <sqlite3.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

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
    /// Called after each call to write, shorten or make durable, on the thread that did it.
    void after_each(std::function<void()> called);
    /// Writes to `folder` what a disk has that loses power now: of each file what was made durable, and of the sectors
    /// that were written since then those that `survives` says, in any order.
    void lose_power(const std::filesystem::path& folder, const std::function<bool()>& survives);

private:
    struct File;
    /// Bytes at a place; or the file's new end.
    struct Change {
        std::int64_t at = 0;
        std::string bytes;
        bool truncates = false;
    };
    struct Image {
        std::string durable;
        std::vector<Change> since;
    };
    Fault next();
    void note(const File* file, Change change);
    void made_durable(const File* file);
    static void apply(const Change& change, std::string& image);
    static void load(const std::string& path, Image& image);

    static File* file_of(sqlite3_file* file);
    static int open(sqlite3_vfs* vfs, sqlite3_filename name, sqlite3_file* file, int flags, int* out);
    static int remove(sqlite3_vfs* vfs, const char* path, int sync_folder);
    static int write(sqlite3_file* file, const void* bytes, int count, sqlite3_int64 at);
    static int truncate(sqlite3_file* file, sqlite3_int64 size);
    static int sync(sqlite3_file* file, int flags);

    static FaultyDisk* now_;
    sqlite3_vfs* real_;
    sqlite3_vfs own_;
    std::atomic<std::int64_t> calls_ = 0;
    std::atomic<std::int64_t> failing_ = -1;
    std::atomic<Fault> fault_ = Fault::none;
    std::mutex mutex_;
    std::map<std::string, Image> images_;  ///< by path
    std::function<void()> called_;
};

}  // namespace tunewright::server
