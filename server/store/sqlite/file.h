// The store's file before it is opened: its folder, its lock, and the files next to it.
#pragma once

#include <string>

namespace tunewright::server {

/// Creates the folder of a new file, but only one level: several missing levels are probably a typing error, or a disk
/// that is not mounted, and an empty store there would look as if all jobs were gone.
void make_folder(const std::string& path);

/// Throws StoreError if the log of changes next to the file belongs to another file: SQLite would write its pages over
/// a copy that replaced the file.
void refuse_foreign_log(const std::string& path);

/// Held while the file is open, so that two services never take each other's jobs, by whatever path each opens it. It
/// locks a separate file that is never deleted: SQLite's own locks are temporary, and a copy may replace the store's
/// file.
class FileLock {
public:
    /// Throws StoreError if another process has the lock.
    explicit FileLock(const std::string& path);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

private:
    int fd_;
};

}  // namespace tunewright::server
