#include "tests/server/store/faulty/disk.h"

#include <cstring>

namespace tunewright::server {

FaultyDisk* FaultyDisk::now_ = nullptr;

/// SQLite's own file behind ours, in one piece of memory.
struct FaultyDisk::File {
    sqlite3_file head;
    sqlite3_io_methods methods;

    sqlite3_file* real() { return reinterpret_cast<sqlite3_file*>(this + 1); }
};

FaultyDisk::FaultyDisk() : real_(sqlite3_vfs_find(nullptr)), own_(*real_) {
    now_ = this;
    own_.zName = "faulty";
    own_.szOsFile = static_cast<int>(sizeof(File)) + real_->szOsFile;
    own_.xOpen = &FaultyDisk::open;
    sqlite3_vfs_register(&own_, 1);
}

FaultyDisk::~FaultyDisk() {
    sqlite3_vfs_unregister(&own_);
    sqlite3_vfs_register(real_, 1);
    now_ = nullptr;
}

void FaultyDisk::fail(std::int64_t number, Fault fault) {
    calls_ = 0;
    fault_ = fault;
    failing_ = number;
}

FaultyDisk::Fault FaultyDisk::next() { return calls_++ == failing_ ? fault_.load() : Fault::none; }

FaultyDisk::File* FaultyDisk::file_of(sqlite3_file* file) { return reinterpret_cast<File*>(file); }

namespace {

sqlite3_file* behind(sqlite3_file* file, std::size_t head) {
    return reinterpret_cast<sqlite3_file*>(reinterpret_cast<char*>(file) + head);
}

}  // namespace

int FaultyDisk::open(sqlite3_vfs*, sqlite3_filename name, sqlite3_file* opened, int flags, int* out) {
    File* file = file_of(opened);
    std::memset(static_cast<void*>(file), 0, sizeof(File));
    const int result = now_->real_->xOpen(now_->real_, name, file->real(), flags, out);
    if (file->real()->pMethods == nullptr) return result;
    constexpr std::size_t head = sizeof(File);
    sqlite3_io_methods& m = file->methods;
    m.iVersion = file->real()->pMethods->iVersion;
    m.xClose = [](sqlite3_file* f) { return behind(f, head)->pMethods->xClose(behind(f, head)); };
    m.xRead = [](sqlite3_file* f, void* to, int count, sqlite3_int64 at) {
        return behind(f, head)->pMethods->xRead(behind(f, head), to, count, at);
    };
    m.xWrite = &FaultyDisk::write;
    m.xTruncate = &FaultyDisk::truncate;
    m.xSync = &FaultyDisk::sync;
    m.xFileSize = [](sqlite3_file* f, sqlite3_int64* size) {
        return behind(f, head)->pMethods->xFileSize(behind(f, head), size);
    };
    m.xLock = [](sqlite3_file* f, int kind) { return behind(f, head)->pMethods->xLock(behind(f, head), kind); };
    m.xUnlock = [](sqlite3_file* f, int kind) { return behind(f, head)->pMethods->xUnlock(behind(f, head), kind); };
    m.xCheckReservedLock = [](sqlite3_file* f, int* found) {
        return behind(f, head)->pMethods->xCheckReservedLock(behind(f, head), found);
    };
    m.xFileControl = [](sqlite3_file* f, int what, void* with) {
        return behind(f, head)->pMethods->xFileControl(behind(f, head), what, with);
    };
    m.xSectorSize = [](sqlite3_file* f) { return behind(f, head)->pMethods->xSectorSize(behind(f, head)); };
    m.xDeviceCharacteristics = [](sqlite3_file* f) {
        return behind(f, head)->pMethods->xDeviceCharacteristics(behind(f, head));
    };
    m.xShmMap = [](sqlite3_file* f, int page, int size, int extend, void volatile** to) {
        return behind(f, head)->pMethods->xShmMap(behind(f, head), page, size, extend, to);
    };
    m.xShmLock = [](sqlite3_file* f, int offset, int count, int kind) {
        return behind(f, head)->pMethods->xShmLock(behind(f, head), offset, count, kind);
    };
    m.xShmBarrier = [](sqlite3_file* f) { behind(f, head)->pMethods->xShmBarrier(behind(f, head)); };
    m.xShmUnmap = [](sqlite3_file* f, int remove) {
        return behind(f, head)->pMethods->xShmUnmap(behind(f, head), remove);
    };
    m.xFetch = [](sqlite3_file* f, sqlite3_int64 at, int count, void** to) {
        return behind(f, head)->pMethods->xFetch(behind(f, head), at, count, to);
    };
    m.xUnfetch = [](sqlite3_file* f, sqlite3_int64 at, void* from) {
        return behind(f, head)->pMethods->xUnfetch(behind(f, head), at, from);
    };
    file->head.pMethods = &m;
    return result;
}

int FaultyDisk::write(sqlite3_file* opened, const void* bytes, int count, sqlite3_int64 at) {
    sqlite3_file* real = file_of(opened)->real();
    switch (now_->next()) {
        case Fault::none: return real->pMethods->xWrite(real, bytes, count, at);
        case Fault::short_write: real->pMethods->xWrite(real, bytes, count / 2, at); return SQLITE_IOERR_WRITE;
        case Fault::full: real->pMethods->xWrite(real, bytes, count / 2, at); return SQLITE_FULL;
        default: return SQLITE_IOERR_WRITE;
    }
}

int FaultyDisk::truncate(sqlite3_file* opened, sqlite3_int64 size) {
    sqlite3_file* real = file_of(opened)->real();
    if (now_->next() != Fault::none) return SQLITE_IOERR_TRUNCATE;
    return real->pMethods->xTruncate(real, size);
}

int FaultyDisk::sync(sqlite3_file* opened, int flags) {
    sqlite3_file* real = file_of(opened)->real();
    if (now_->next() != Fault::none) return SQLITE_IOERR_FSYNC;
    const int result = real->pMethods->xSync(real, flags);
    if (now_->synced_) now_->synced_();
    return result;
}

}  // namespace tunewright::server
