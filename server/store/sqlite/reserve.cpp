#include "server/store/sqlite/reserve.h"

#include <fcntl.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <limits>

namespace tunewright::server {
namespace {

constexpr std::size_t kMaxReserve = 4 << 20;
constexpr std::size_t kFileSystemShare = 8;
constexpr std::size_t kScarceBytes = 1 << 20;

}  // namespace

Reserve::Reserve(const std::string& path)
    : file_(std::filesystem::weakly_canonical(path).string() + "-reserve"),
      wanted_(std::min(kMaxReserve, room_of(file_).whole / kFileSystemShare)) {
    std::error_code none;
    const auto size = std::filesystem::file_size(file_, none);
    if (!none) bytes_ = static_cast<std::size_t>(size);
}

void Reserve::fill() {
    const std::size_t bytes = std::min(wanted_, bytes_ + room_of(file_).left);
    if (bytes < bytes_ + kMinBytes) return;
    const int fd = ::open(file_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600);
    if (fd < 0) return;
    if (::posix_fallocate(fd, 0, static_cast<off_t>(bytes)) == 0) bytes_ = bytes;
    ::close(fd);
}

bool Reserve::release(bool all) {
    const std::size_t kept = all ? 0 : wanted_ / 2;
    if (bytes_ <= kept) return false;
    bytes_ = kept;
    return ::truncate(file_.c_str(), static_cast<off_t>(kept)) == 0;
}

bool Reserve::is_scarce() const { return room_of(file_).left + bytes_ < wanted_ + std::min(wanted_, kScarceBytes); }

DiskRoom room_of(const std::string& path) {
    constexpr std::size_t unknown = std::numeric_limits<std::size_t>::max() / 2;
    struct statvfs disk {};
    const std::string folder = std::filesystem::path(path).parent_path().string();
    if (::statvfs(folder.empty() ? "." : folder.c_str(), &disk) != 0) return {unknown, unknown};
    return {static_cast<std::size_t>(disk.f_blocks) * disk.f_frsize,
            static_cast<std::size_t>(disk.f_bavail) * disk.f_frsize};
}

}  // namespace tunewright::server
