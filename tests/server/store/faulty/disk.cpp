#include "tests/server/store/faulty/disk.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>

namespace tunewright::server {

FaultyDisk* FaultyDisk::now_ = nullptr;

/// SQLite's own file, in one piece of memory.
struct FaultyDisk::File {
    sqlite3_file head;
    sqlite3_io_methods methods;
    const char* path;  ///< SQLite stores it as long as the file is open; null for temporary files

    sqlite3_file* real() { return reinterpret_cast<sqlite3_file*>(this + 1); }
};

FaultyDisk::FaultyDisk() : real_(sqlite3_vfs_find(nullptr)), own_(*real_) {
    now_ = this;
    own_.zName = "faulty";
    own_.szOsFile = static_cast<int>(sizeof(File)) + real_->szOsFile;
    own_.xOpen = &FaultyDisk::open;
    own_.xDelete = &FaultyDisk::remove;
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
    file->path = name;
    if (name != nullptr) {
        const std::lock_guard lock(now_->mutex_);
        if (!now_->images_.contains(name)) load(name, now_->images_[name]);
    }
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

int FaultyDisk::remove(sqlite3_vfs*, const char* path, int sync_folder) {
    {
        const std::lock_guard lock(now_->mutex_);
        now_->images_.erase(path);
    }
    return now_->real_->xDelete(now_->real_, path, sync_folder);
}

int FaultyDisk::write(sqlite3_file* opened, const void* bytes, int count, sqlite3_int64 at) {
    File* file = file_of(opened);
    const Fault fault = now_->next();
    const int written = fault == Fault::none                                  ? count
                        : fault == Fault::short_write || fault == Fault::full ? count / 2
                                                                              : 0;
    int result = SQLITE_OK;
    if (written > 0) result = file->real()->pMethods->xWrite(file->real(), bytes, written, at);
    now_->note(file, {at, std::string(static_cast<const char*>(bytes), static_cast<std::size_t>(written)), false});
    if (fault == Fault::none) return result;
    return fault == Fault::full ? SQLITE_FULL : SQLITE_IOERR_WRITE;
}

int FaultyDisk::truncate(sqlite3_file* opened, sqlite3_int64 size) {
    File* file = file_of(opened);
    if (now_->next() != Fault::none) return SQLITE_IOERR_TRUNCATE;
    const int result = file->real()->pMethods->xTruncate(file->real(), size);
    now_->note(file, {size, "", true});
    return result;
}

int FaultyDisk::sync(sqlite3_file* opened, int flags) {
    File* file = file_of(opened);
    if (now_->next() != Fault::none) return SQLITE_IOERR_FSYNC;
    const int result = file->real()->pMethods->xSync(file->real(), flags);
    now_->made_durable(file);
    return result;
}

// ---- power

void FaultyDisk::after_each(std::function<void()> called) {
    const std::lock_guard lock(mutex_);
    called_ = std::move(called);
}

void FaultyDisk::load(const std::string& path, Image& image) {
    std::ifstream file(path, std::ios::binary);
    image.durable.assign(std::istreambuf_iterator<char>(file), {});
}

void FaultyDisk::apply(const Change& change, std::string& image) {
    const auto at = static_cast<std::size_t>(change.at);
    if (change.truncates) return image.resize(at);
    image.resize(std::max(image.size(), at + change.bytes.size()));
    image.replace(at, change.bytes.size(), change.bytes);
}

void FaultyDisk::note(const File* file, Change change) {
    std::function<void()> called;
    {
        const std::lock_guard lock(mutex_);
        if (file->path == nullptr) return;
        images_[file->path].since.push_back(std::move(change));
        called = called_;
    }
    if (called) called();
}

void FaultyDisk::made_durable(const File* file) {
    std::function<void()> called;
    {
        const std::lock_guard lock(mutex_);
        if (file->path == nullptr) return;
        Image& image = images_[file->path];
        for (const Change& change : image.since) apply(change, image.durable);
        image.since.clear();
        called = called_;
    }
    if (called) called();
}

void FaultyDisk::lose_power(const std::filesystem::path& folder, const std::function<bool()>& survives) {
    constexpr std::size_t sector = 512;
    const std::lock_guard lock(mutex_);
    for (const auto& [path, image] : images_) {
        std::string left = image.durable;
        for (const Change& change : image.since) {
            if (change.truncates && survives()) apply(change, left);
            for (std::size_t at = 0; at < change.bytes.size(); at += sector)
                if (survives())
                    apply({change.at + static_cast<std::int64_t>(at), change.bytes.substr(at, sector), false}, left);
        }
        std::ofstream(folder / std::filesystem::path(path).filename(), std::ios::binary) << left;
    }
}

}  // namespace tunewright::server
