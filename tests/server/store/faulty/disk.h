// A disk that fails on demand: SQLite's own file system with a counter in front of it.
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

/// Replaces SQLite's file system during its lifetime, for every file that is then opened; one at a time.
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

    /// The call `number` (from 0) to write, truncate or sync fails in this way; later ones work again.
    void fail(std::int64_t number, Fault fault);
    /// Calls so far, since fail().
    std::int64_t calls() const { return calls_; }
    /// Called after each call to write, truncate or sync, on its thread.
    void after_each(std::function<void()> called);
    /// Writes to `folder` the content of a disk that loses power now: for each file the synced data, and those sectors
    /// written since then that `survives` selects, in any order.
    void lose_power(const std::filesystem::path& folder, const std::function<bool()>& survives);

private:
    struct File;
    /// Bytes at an offset; or the file's new length.
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
