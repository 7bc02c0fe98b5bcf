#include "server/store/sqlite/sqlite_store.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <future>
#include <limits>
#include <mutex>
#include <type_traits>

#include "server/clock.h"
#include "server/store/sqlite/batches.h"
#include "server/store/sqlite/jobs.h"
#include "server/store/sqlite/reading.h"
#include "server/store/sqlite/writer.h"

namespace tunewright::server {
namespace {

constexpr UnixMs kEver = std::numeric_limits<UnixMs>::max();
constexpr const char* kPageCache = "PRAGMA cache_size = -16384";  // KiB; the default of 2 MiB thrashes in long queues

/// Held while the file is open, so that two services never take each other's jobs.
class FileLock {
public:
    explicit FileLock(const std::string& path) : fd_(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {
        if (fd_ < 0) throw StoreError({StoreFault::Kind::unavailable, "its lock file " + path + " cannot be created"});
        if (::flock(fd_, LOCK_EX | LOCK_NB) != 0) {
            ::close(fd_);
            throw StoreError({StoreFault::Kind::unavailable, "another tunewright is using it"});
        }
    }
    ~FileLock() { ::close(fd_); }
    FileLock(const FileLock&) = delete;
    FileLock& operator=(const FileLock&) = delete;

private:
    int fd_;
};

class SqliteStore : public JobStore {
public:
    explicit SqliteStore(const std::string& path)
        : path_(path), lock_(path + ".lock"), connection_(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE) {
        connection_.database().exec("PRAGMA journal_mode = WAL");
        // Debian's library writes zeros over each page that it frees, which is most of what deleting costs.
        connection_.database().exec("PRAGMA secure_delete = FAST");
        connection_.database().exec(kPageCache);
        migrate(connection_.database());
        writer_ = std::make_unique<SqliteWriter>(connection_);
    }

    ~SqliteStore() override {
        if (writer_) writer_->stop();
    }

    bool shared() const override { return false; }
    void watch(std::function<void(const StoreNotice&)>) override {}
    bool healthy() const override { return writer_->healthy(); }

    Recovery recover(UnixMs now, int attempts, const std::string& error) override;
    void reclaim(Reclaim what, Done<Recovery> done) override;

    std::optional<JobRecord> find(const std::string& id) override {
        return read([&](Connection& store) { return find_record(store, id); });
    }
    std::vector<JobState> states(const std::vector<std::string>& ids) override {
        return read([&](Connection& store) { return find_states(store, ids); });
    }
    JobPage list(const JobQuery& query) override {
        return read([&](Connection& store) { return list_jobs(store, query); });
    }
    Depth depth() override { return read(count_waiting); }

    void accept(NewJob job, Done<Accepted> done) override {
        const auto work = [job = std::move(job)](Connection& store) { return accept_job(store, job); };
        write<Accepted>(kDurable, work, std::move(done));
    }
    void claim(Claim claim, Done<std::vector<JobRecord>> done) override {
        // Not waiting for the disk: after a power cut the job is queued again, which is where it belongs anyway.
        const auto work = [claim = std::move(claim)](Connection& store) { return claim_jobs(store, claim); };
        write<std::vector<JobRecord>>(kQuick, work, std::move(done));
    }
    void renew(std::vector<Renewal> renewals, UnixMs now, std::chrono::milliseconds lease,
               Done<std::vector<Renewed>> done) override {
        const auto work = [renewals = std::move(renewals), until = now + lease.count()](Connection& store) {
            return renew_jobs(store, renewals, until);
        };
        write<std::vector<Renewed>>(kQuick, work, std::move(done));
    }
    void finish(JobEnd end, Done<bool> done) override {
        const auto work = [end = std::move(end)](Connection& store) { return finish_job(store, end); };
        write<bool>(kDurable, work, std::move(done));
    }
    void release(std::string id, int attempts, Done<bool> done) override {
        const auto work = [id = std::move(id), attempts](Connection& store) {
            return release_job(store, id, attempts, wall_clock());
        };
        write<bool>(kDurable, work, std::move(done));
    }
    void cancel(std::string id, UnixMs now, Done<CancelEffect> done) override {
        const auto work = [id = std::move(id), now](Connection& store) { return cancel_job(store, id, now); };
        write<CancelEffect>(kDurable, work, std::move(done));
    }
    void remove(std::string id, Done<RemoveEffect> done) override {
        const auto work = [id = std::move(id)](Connection& store) { return remove_job(store, id); };
        write<RemoveEffect>(kDurable, work, std::move(done));
    }

    void open_batch(NewBatch batch, Done<bool> done) override {
        const auto work = [batch = std::move(batch)](Connection& store) {
            server::open_batch(store, batch);
            return true;
        };
        write<bool>(kBulky, work, std::move(done));
    }
    void add_entries(std::string batch, std::vector<NewEntry> entries, UnixMs now, Done<bool> done) override {
        const auto work = [batch = std::move(batch), entries = std::move(entries), now](Connection& store) {
            return server::add_entries(store, batch, entries, now);
        };
        write<bool>(kBulky, work, std::move(done));
    }
    void seal_batch(BatchSeal seal, Done<Sealed> done) override;
    void drop_batch(std::string batch, Done<bool> done) override;
    void cancel_batch(std::string id, UnixMs now, Done<std::optional<std::vector<std::string>>> done) override;
    void remove_batch(std::string id, Done<RemoveEffect> done) override;
    void sweep(UnixMs now, std::chrono::milliseconds age, std::size_t most, Done<std::size_t> done) override {
        sweep_on(now - age.count(), most, 0, std::move(done));
    }

    std::optional<BatchSummary> find_batch(const std::string& id) override {
        return read([&](Connection& store) { return server::find_batch(store, id); });
    }
    std::optional<std::string> batch_of_key(const std::string& owner, const std::string& idempotency_key) override {
        return read([&](Connection& store) { return find_batch_of_key(store, owner, idempotency_key); });
    }
    BatchPage list_batches(const std::optional<std::string>& owner, int limit,
                           std::optional<std::int64_t> before_seq) override {
        return read([&](Connection& store) { return server::list_batches(store, owner, limit, before_seq); });
    }
    std::vector<BatchRow> batch_rows(const std::string& id, std::int64_t from, std::size_t limit) override {
        return read([&](Connection& store) { return find_rows(store, id, from, limit); });
    }

private:
    /// Idle: bulky, and not waiting for the disk: after a power cut it is done again.
    enum Manner { kDurable, kQuick, kBulky, kIdle };

    /// Queues `work` for the writer and passes its value on after the commit.
    template <class T, class Work>
    void write(Manner manner, Work work, Done<T> done) {
        auto value = std::make_shared<T>();
        SqliteWriter::Change change;
        change.apply = [value, work = std::move(work)](Connection& store) { *value = work(store); };
        change.done = [value, done = std::move(done)](const std::optional<StoreFault>& fault) {
            fault ? done(*fault) : done(std::move(*value));
        };
        change.durable = manner == kDurable || manner == kBulky;
        change.bulky = manner == kBulky || manner == kIdle;
        writer_->submit(std::move(change));
    }

    /// Waits for a change; only while no callback of the writer's is waiting for this thread.
    template <class T, class Work>
    T write_now(Work work) {
        std::promise<Outcome<T>> promise;
        write<T>(kBulky, std::move(work), [&](Outcome<T> outcome) { promise.set_value(std::move(outcome)); });
        Outcome<T> outcome = promise.get_future().get();
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) throw StoreError(*fault);
        return std::get<T>(std::move(outcome));
    }

    template <class Work>
    std::invoke_result_t<Work, Connection&> read(Work work) {
        std::unique_ptr<Connection> reader;
        {
            const std::lock_guard lock(readers_mutex_);
            if (!readers_.empty()) {
                reader = std::move(readers_.back());
                readers_.pop_back();
            }
        }
        try {
            if (!reader) reader = std::make_unique<Connection>(path_, SQLite::OPEN_READONLY);
            auto value = work(*reader);
            const std::lock_guard lock(readers_mutex_);
            readers_.push_back(std::move(reader));
            return value;
        } catch (const SQLite::Exception& error) {
            throw StoreError(fault_of(error));
        }
    }

    void delete_batch(std::int64_t batch, std::function<void(std::optional<StoreFault>)> done);
    void cancel_slices(std::int64_t batch, UnixMs now, Done<std::vector<std::string>> done);
    void sweep_on(UnixMs ended_before, std::size_t most, std::size_t gone, Done<std::size_t> done);

    std::string path_;
    FileLock lock_;
    Connection connection_;
    std::mutex readers_mutex_;
    std::vector<std::unique_ptr<Connection>> readers_;
    std::unique_ptr<SqliteWriter> writer_;
};

Recovery SqliteStore::recover(UnixMs now, int attempts, const std::string& error) {
    // What was interrupted is finished first, slice by slice, so that none of it is taken for waiting jobs.
    const auto leaving =
        write_now<std::vector<std::int64_t>>([](Connection& store) { return leave_unheard(store, kEver); });
    for (const std::int64_t batch : leaving)
        while (write_now<std::size_t>([&](Connection& store) { return delete_entries(store, batch, kSlice); }) > 0) {
        }
    for (const std::int64_t batch :
         write_now<std::vector<std::int64_t>>([](Connection& store) { return being_cancelled(store); })) {
        while (write_now<bool>([&](Connection& store) { return cancel_entries(store, batch, now); })) {
        }
        write_now<std::vector<std::string>>([&](Connection& store) { return end_cancel(store, batch); });
    }
    return write_now<Recovery>([&](Connection& store) { return reclaim_jobs(store, kEver, now, attempts, error); });
}

void SqliteStore::reclaim(Reclaim what, Done<Recovery> done) {
    struct Found {
        Recovery recovery;
        std::vector<std::int64_t> leaving;
    };
    const auto work = [what = std::move(what)](Connection& store) {
        Found found;
        if (what.leases) found.recovery = reclaim_jobs(store, what.now, what.now, what.most_attempts, what.error);
        found.leaving = leave_unheard(store, what.now - kReceiving.count());
        return found;
    };
    write<Found>(kBulky, work, [this, done = std::move(done)](Outcome<Found> outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) return done(*fault);
        auto& found = std::get<Found>(outcome);
        for (const std::int64_t batch : found.leaving) delete_batch(batch, [](const std::optional<StoreFault>&) {});
        done(std::move(found.recovery));
    });
}

// ---- long changes, slice by slice --------------------------------------------------------------------------------

void SqliteStore::delete_batch(std::int64_t batch, std::function<void(std::optional<StoreFault>)> done) {
    const auto work = [batch](Connection& store) { return delete_entries(store, batch, kSlice); };
    write<std::size_t>(kBulky, work, [this, batch, done = std::move(done)](const Outcome<std::size_t>& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) return done(*fault);
        std::get<std::size_t>(outcome) > 0 ? delete_batch(batch, done) : done(std::nullopt);
    });
}

void SqliteStore::seal_batch(BatchSeal seal, Done<Sealed> done) {
    const auto work = [seal = std::move(seal)](Connection& store) { return server::seal_batch(store, seal); };
    write<SealedBatch>(kBulky, work, [this, done = std::move(done)](Outcome<SealedBatch> outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) return done(*fault);
        auto& sealed = std::get<SealedBatch>(outcome);
        if (!sealed.leaving) return done(std::move(sealed.answer));
        delete_batch(*sealed.leaving, [answer = std::move(sealed.answer), done](const std::optional<StoreFault>&) {
            done(answer);  // whatever could not be deleted now is not seen, and goes at the next start
        });
    });
}

void SqliteStore::drop_batch(std::string batch, Done<bool> done) {
    const auto work = [batch = std::move(batch)](Connection& store) { return leave_batch(store, batch); };
    using Found = std::optional<std::int64_t>;
    write<Found>(kBulky, work, [this, done = std::move(done)](const Outcome<Found>& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) return done(*fault);
        const auto found = std::get<Found>(outcome);
        if (!found) return done(false);
        delete_batch(*found, [done](const std::optional<StoreFault>& fault) { fault ? done(*fault) : done(true); });
    });
}

void SqliteStore::remove_batch(std::string id, Done<RemoveEffect> done) {
    const auto work = [id = std::move(id)](Connection& store) { return server::remove_batch(store, id); };
    write<RemovedBatch>(kBulky, work, [this, done = std::move(done)](const Outcome<RemovedBatch>& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) return done(*fault);
        const auto& removed = std::get<RemovedBatch>(outcome);
        if (removed.effect != RemoveEffect::removed) return done(removed.effect);
        delete_batch(removed.leaving, [done](const std::optional<StoreFault>& fault) {
            fault ? done(*fault) : done(RemoveEffect::removed);
        });
    });
}

void SqliteStore::cancel_batch(std::string id, UnixMs now, Done<std::optional<std::vector<std::string>>> done) {
    const auto work = [id = std::move(id)](Connection& store) { return begin_cancel(store, id); };
    using Found = std::optional<std::int64_t>;
    write<Found>(kBulky, work, [this, now, done = std::move(done)](const Outcome<Found>& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) return done(*fault);
        const auto found = std::get<Found>(outcome);
        if (!found) return done(std::nullopt);
        cancel_slices(*found, now, [done](Outcome<std::vector<std::string>> ids) {
            if (const auto* fault = std::get_if<StoreFault>(&ids)) return done(*fault);
            done(std::get<std::vector<std::string>>(std::move(ids)));
        });
    });
}

void SqliteStore::cancel_slices(std::int64_t batch, UnixMs now, Done<std::vector<std::string>> done) {
    const auto work = [batch, now](Connection& store) { return cancel_entries(store, batch, now); };
    write<bool>(kBulky, work, [this, batch, now, done = std::move(done)](const Outcome<bool>& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) return done(*fault);
        if (std::get<bool>(outcome)) return cancel_slices(batch, now, done);
        const auto end = [batch](Connection& store) { return end_cancel(store, batch); };
        write<std::vector<std::string>>(kBulky, end, done);
    });
}

void SqliteStore::sweep_on(UnixMs ended_before, std::size_t most, std::size_t gone, Done<std::size_t> done) {
    const auto work = [ended_before, left = most - gone](Connection& store) {
        return left == 0 ? 0 : sweep_slice(store, ended_before, left);
    };
    write<std::size_t>(kIdle, work, [=, this, done = std::move(done)](const Outcome<std::size_t>& outcome) {
        if (const auto* fault = std::get_if<StoreFault>(&outcome)) return done(*fault);
        const std::size_t slice = std::get<std::size_t>(outcome);
        slice > 0 ? sweep_on(ended_before, most, gone + slice, done) : done(gone);
    });
}

}  // namespace

std::unique_ptr<JobStore> open_sqlite_store(const std::string& path) {
    try {
        const std::filesystem::path folder = std::filesystem::path(path).parent_path();
        if (!folder.empty()) std::filesystem::create_directories(folder);
        return std::make_unique<SqliteStore>(path);
    } catch (const std::exception& error) {
        throw StoreError({StoreFault::Kind::unavailable, "Cannot open the store " + path + ": " + error.what() + "."});
    }
}

}  // namespace tunewright::server
