#include "server/store/sqlite/file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>

#include "server/store/fault.h"

namespace tunewright::server {
namespace {

/// The target of a link: SQLite keeps its log of changes (WAL) there too.
std::string file_behind(const std::string& path) { return std::filesystem::weakly_canonical(path).string(); }

/// True if the file's head says that a log of changes may be next to it. Also true of a file without a head.
bool may_have_log(const std::string& path) {
    constexpr std::streamoff write_version = 18, read_version = 19;
    constexpr char with_log = 2;
    std::array<char, read_version + 1> head{};
    std::ifstream file(path, std::ios::binary);
    if (!file.read(head.data(), head.size())) return true;
    return head[write_version] == with_log && head[read_version] == with_log;
}

}  // namespace

void make_folder(const std::string& path) {
    const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
    if (std::filesystem::exists(folder)) return;
    if (!std::filesystem::exists(folder.parent_path()) || folder.parent_path() == folder.root_path())
        throw StoreError({StoreFault::Kind::unavailable,
                          "there is no folder " + folder.string() + "; create it, or correct the path"});
    std::filesystem::create_directory(folder);
}

void refuse_foreign_log(const std::string& path) {
    const std::string file = file_behind(path), log = file + "-wal";
    std::error_code none;
    const auto size = std::filesystem::file_size(log, none);
    // SQLite marks the file before it creates a log, and removes the log before it removes the mark.
    if (none || size == 0 || may_have_log(file)) return;
    throw StoreError({StoreFault::Kind::unavailable, "the file is a copy that replaced the original, and " + log +
                                                         " belongs to the original; remove it and " + file +
                                                         "-shm, then start again"});
}

FileLock::FileLock(const std::string& path) {
    const std::string lock = file_behind(path) + ".lock";
    fd_ = ::open(lock.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (fd_ < 0) throw StoreError({StoreFault::Kind::unavailable, "its lock file " + lock + " cannot be created"});
    if (::flock(fd_, LOCK_EX | LOCK_NB) != 0) {
        ::close(fd_);
        throw StoreError({StoreFault::Kind::unavailable, "another tunewright is using it"});
    }
}

FileLock::~FileLock() { ::close(fd_); }

}  // namespace tunewright::server
