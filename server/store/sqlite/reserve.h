// Room on the store's disk that is kept for what gives room back: deleting and sweeping write a little before they free
// much, and on a disk that is full to the last byte neither could begin.
#pragma once

#include <cstddef>
#include <string>

namespace tunewright::server {

class Reserve {
public:
    /// The reserve of the database at `path`; nothing is taken yet. A file that an earlier process left is kept.
    explicit Reserve(const std::string& path);

    /// Takes an eighth of the disk, at most 4 MiB, or as much of that as there is.
    void fill();
    /// Gives all of it, or what is more than half, to the disk; false where there is no more than that.
    bool release(bool all = true);
    bool filled() const { return bytes_ + kMinBytes > wanted_; }
    /// True where the disk has less left than new jobs should leave for the results of those that are there.
    bool is_scarce() const;

private:
    static constexpr std::size_t kMinBytes = 64 << 10;  ///< what is worth taking
    const std::string file_;
    std::size_t wanted_ = 0, bytes_ = 0;
};

struct DiskRoom {
    std::size_t whole, left;  ///< bytes, of the file system and for this process; where nothing is known no end of them
};

DiskRoom room_of(const std::string& path);

}  // namespace tunewright::server
