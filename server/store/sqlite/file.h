// The store's file before it is opened: its folder, its lock, and what lies beside it.
#pragma once

#include <string>

namespace tunewright::server {

/// A file that is to be made needs its folder. More than one is perhaps a word that was mistyped, or a disk that is not
/// mounted: an empty store there would look as if all jobs were gone.
void make_folder(const std::string& path);

/// Throws StoreError where the log of changes beside the file is another file's: SQLite would write its pages over a
/// copy that was put in the file's place.
void refuse_foreign_log(const std::string& path);

/// Held while the file is open, so that two services never take each other's jobs, by whatever name each calls it. The
/// lock is of a file beside it, which stays: SQLite's own locks come and go, and a copy may take the file's place.
class FileLock {
public:
    /// Throws StoreError where another has it.
    explicit FileLock(const std::string& path);
    ~FileLock();
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

private:
    int fd_;
};

}  // namespace tunewright::server
