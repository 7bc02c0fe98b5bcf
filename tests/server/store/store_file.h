// A folder for one test with the store's file in it, and statements that access the database directly.
#pragma once

#include <sqlite3.h>

#include <cstdlib>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>

namespace tunewright::server {

/// The folder is deleted at the end of the test.
class TemporaryFolder {
public:
    explicit TemporaryFolder(const std::filesystem::path& in = std::filesystem::temp_directory_path()) {
        std::string name = (in / "tunewright-store-XXXXXX").string();
        path_ = ::mkdtemp(name.data());
    }
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }
    std::string file() const { return (path_ / "jobs.db").string(); }

private:
    std::filesystem::path path_;
};

/// In memory if possible: a disk would take minutes to make the writes of these tests durable.
inline std::string scratch() {
    const bool memory = std::filesystem::is_directory("/dev/shm");
    return memory ? "/dev/shm" : std::filesystem::temp_directory_path().string();
}

/// Runs statements; the first column of the last row, "" if there is none. Throws SQLite's errors.
inline std::string run_sqlite(const std::string& file, const std::string& sql) {
    sqlite3* opened = nullptr;
    const int open = sqlite3_open(file.c_str(), &opened);
    const std::unique_ptr<sqlite3, int (*)(sqlite3*)> database(opened, &sqlite3_close);
    std::string found;
    const auto keep = [](void* into, int, char** values, char**) {
        *static_cast<std::string*>(into) = values[0] != nullptr ? values[0] : "";
        return 0;
    };
    if (open != SQLITE_OK || sqlite3_exec(opened, sql.c_str(), keep, &found, nullptr) != SQLITE_OK)
        throw std::runtime_error(sqlite3_errmsg(opened));
    return found;
}

}  // namespace tunewright::server
