// Disk space that is reserved for operations that free space: deleting and sweeping write a little before they free
// much, and on a completely full disk neither could begin.
#pragma once

#include <cstddef>
#include <string>

namespace tunewright::server {

class Reserve {
public:
    /// The reserve of the database at `path`; nothing is allocated yet. A file that an earlier process left is used.
    explicit Reserve(const std::string& path);

    /// Allocates an eighth of the disk, at most 4 MiB, or the part of that which is available.
    void fill();
    /// Returns all of it, or the part above half, to the disk; false if there is no more than that.
    bool release(bool all = true);
    bool filled() const { return bytes_ + kMinBytes > wanted_; }
    /// True if the disk has less space left than new jobs should leave for the results of existing ones.
    bool is_scarce() const;

private:
    static constexpr std::size_t kMinBytes = 64 << 10;  ///< smaller reserves are not allocated
    const std::string file_;
    std::size_t wanted_ = 0, bytes_ = 0;
};

struct DiskRoom {
    std::size_t whole, left;  ///< bytes, of the file system and for this process; the largest number if unknown
};

DiskRoom room_of(const std::string& path);

}  // namespace tunewright::server
