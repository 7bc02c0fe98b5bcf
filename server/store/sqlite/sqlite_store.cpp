#include "server/store/sqlite/sqlite_store.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <filesystem>
#include <mutex>

#include "server/store/sqlite/schema.h"
#include "server/store/sqlite/writer.h"

namespace tunewright::server {
namespace {

constexpr const char* kSummaryColumns =
    "j.seq, j.id, j.name, j.status, j.created_at, j.started_at, j.finished_at, j.attempts, j.timeout_s, "
    "j.request_hash, j.cancel_requested";
constexpr int kSummaryCount = 11;

std::string text(SQLite::Statement& row, int column) {
    const SQLite::Column value = row.getColumn(column);
    return value.isNull() ? std::string{} : value.getString();
}

std::optional<UnixMs> moment(SQLite::Statement& row, int column) {
    const SQLite::Column value = row.getColumn(column);
    return value.isNull() ? std::nullopt : std::optional<UnixMs>(value.getInt64());
}

JobSummary read_summary(SQLite::Statement& row) {
    JobSummary job;
    job.seq = row.getColumn(0).getInt64();
    job.id = text(row, 1);
    job.name = text(row, 2);
    job.status = job_status(text(row, 3)).value();
    job.created_at = row.getColumn(4).getInt64();
    job.started_at = moment(row, 5);
    job.finished_at = moment(row, 6);
    job.attempts = row.getColumn(7).getInt();
    job.timeout_s = row.getColumn(8).getDouble();
    job.request_hash = text(row, 9);
    job.cancel_requested = row.getColumn(10).getInt() != 0;
    return job;
}

/// A prepared statement that is put back to its start when the block ends.
class Prepared {
public:
    Prepared(SQLite::Database& database, std::unique_ptr<SQLite::Statement>& slot, const std::string& sql) {
        if (!slot) slot = std::make_unique<SQLite::Statement>(database, sql);
        statement_ = slot.get();
    }
    ~Prepared() {
        statement_->tryReset();
        statement_->clearBindings();
    }
    Prepared(const Prepared&) = delete;
    Prepared& operator=(const Prepared&) = delete;
    SQLite::Statement* operator->() { return statement_; }
    SQLite::Statement& operator*() { return *statement_; }

private:
    SQLite::Statement* statement_;
};

void configure(SQLite::Database& database) {
    database.setBusyTimeout(5000);
    database.exec("PRAGMA foreign_keys = ON");
}

/// One connection that only reads, with its statements.
struct Reader {
    explicit Reader(const std::string& path) : database(path, SQLite::OPEN_READONLY) { configure(database); }
    SQLite::Database database;
    std::unique_ptr<SQLite::Statement> find;
};

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
        : path_(path), lock_(path + ".lock"), database_(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE) {
        configure(database_);
        database_.exec("PRAGMA journal_mode = WAL");
        migrate(database_);
        writer_ = std::make_unique<SqliteWriter>(database_);
    }

    ~SqliteStore() override { writer_.reset(); }

    Recovery recover(UnixMs now, int attempts, const std::string& error) override;
    std::optional<JobRecord> find(const std::string& id) override;
    JobPage list(const JobQuery& query) override;
    void accept(NewJob job, Done<Accepted> done) override;
    void claim_next(UnixMs now, Done<std::optional<JobRecord>> done) override;
    void finish(JobEnd end, Done<bool> done) override;
    void release(std::string id, Done<bool> done) override;
    void cancel(std::string id, UnixMs now, Done<CancelEffect> done) override;
    void remove(std::string id, Done<RemoveEffect> done) override;
    bool healthy() const override { return writer_->healthy(); }

private:
    /// Queues `work` for the writer and passes its value on after the commit.
    template <class T, class Work>
    void write(bool durable, Work work, Done<T> done) {
        auto value = std::make_shared<T>();
        writer_->submit(
            {[value, work = std::move(work)](SQLite::Database& database) mutable { *value = work(database); },
             [value, done = std::move(done)](const std::optional<StoreFault>& fault) {
                 fault ? done(*fault) : done(std::move(*value));
             },
             durable});
    }

    template <class Work>
    auto read(Work work) {
        std::unique_ptr<Reader> reader;
        {
            const std::lock_guard lock(readers_mutex_);
            if (!readers_.empty()) {
                reader = std::move(readers_.back());
                readers_.pop_back();
            }
        }
        try {
            if (!reader) reader = std::make_unique<Reader>(path_);
            auto value = work(*reader);
            const std::lock_guard lock(readers_mutex_);
            readers_.push_back(std::move(reader));
            return value;
        } catch (const SQLite::Exception& error) {
            throw StoreError(fault_of(error));
        }
    }

    Accepted insert(SQLite::Database& database, const NewJob& job);
    std::optional<Accepted> find_by_key(SQLite::Database& database, const NewJob& job);
    std::optional<std::pair<std::int64_t, JobStatus>> status_of(SQLite::Database& database, const std::string& id);

    std::string path_;
    FileLock lock_;
    SQLite::Database database_;
    // Statements of the writer's connection; used on the writer's thread alone.
    std::unique_ptr<SQLite::Statement> insert_job_, insert_request_, insert_result_, claim_, load_request_, end_,
        status_of_;
    std::mutex readers_mutex_;
    std::vector<std::unique_ptr<Reader>> readers_;
    std::unique_ptr<SqliteWriter> writer_;
};

Recovery SqliteStore::recover(UnixMs now, int attempts, const std::string& error) {
    Recovery recovery;
    SQLite::Transaction transaction(database_, SQLite::TransactionBehavior::IMMEDIATE);
    SQLite::Statement cancelled(database_,
                                "UPDATE jobs SET status = 'cancelled', finished_at = ? "
                                "WHERE status = 'running' AND cancel_requested = 1");
    cancelled.bind(1, now);
    cancelled.exec();

    SQLite::Statement errors(database_,
                             "INSERT INTO results (seq, error) "
                             "SELECT seq, ? FROM jobs WHERE status = 'running' AND attempts >= ?");
    errors.bind(1, error);
    errors.bind(2, attempts);
    errors.exec();
    SQLite::Statement failed(database_,
                             "UPDATE jobs SET status = 'failed', finished_at = ? "
                             "WHERE status = 'running' AND attempts >= ?");
    failed.bind(1, now);
    failed.bind(2, attempts);
    recovery.given_up = static_cast<std::size_t>(failed.exec());

    recovery.interrupted =
        static_cast<std::size_t>(database_.exec("UPDATE jobs SET status = 'queued' WHERE status = 'running'"));
    recovery.queued =
        static_cast<std::size_t>(database_.execAndGet("SELECT count(*) FROM jobs WHERE status = 'queued'").getInt64());
    transaction.commit();
    return recovery;
}

std::optional<JobRecord> SqliteStore::find(const std::string& id) {
    return read([&](Reader& reader) -> std::optional<JobRecord> {
        Prepared row(reader.database, reader.find,
                     std::string("SELECT ") + kSummaryColumns +
                         ", q.body, r.body, r.error FROM jobs j JOIN requests q ON q.seq = j.seq "
                         "LEFT JOIN results r ON r.seq = j.seq WHERE j.id = ?");
        row->bind(1, id);
        if (!row->executeStep()) return std::nullopt;
        JobRecord job;
        static_cast<JobSummary&>(job) = read_summary(*row);
        job.request = text(*row, kSummaryCount);
        job.result = text(*row, kSummaryCount + 1);
        job.error = text(*row, kSummaryCount + 2);
        return job;
    });
}

JobPage SqliteStore::list(const JobQuery& query) {
    return read([&](Reader& reader) {
        std::string sql = std::string("SELECT ") + kSummaryColumns + " FROM jobs j WHERE 1 = 1";
        if (query.status) sql += " AND j.status = :status";
        if (query.name) sql += " AND j.name = :name";
        if (query.before_seq) sql += " AND j.seq < :before";
        sql += " ORDER BY j.seq DESC LIMIT :limit";
        SQLite::Statement row(reader.database, sql);
        if (query.status) row.bind(":status", std::string(to_string(*query.status)));
        if (query.name) row.bind(":name", *query.name);
        if (query.before_seq) row.bind(":before", *query.before_seq);
        row.bind(":limit", query.limit + 1);
        JobPage page;
        while (row.executeStep()) page.jobs.push_back(read_summary(row));
        page.more = page.jobs.size() > static_cast<std::size_t>(query.limit);
        if (page.more) page.jobs.pop_back();
        return page;
    });
}

std::optional<Accepted> SqliteStore::find_by_key(SQLite::Database& database, const NewJob& job) {
    SQLite::Statement row(database, std::string("SELECT ") + kSummaryColumns +
                                        " FROM idempotency_keys k JOIN jobs j ON j.seq = k.seq WHERE k.key = ?");
    row.bind(1, job.idempotency_key);
    if (!row.executeStep()) return std::nullopt;
    Accepted accepted;
    accepted.job = read_summary(row);
    accepted.kind = accepted.job.request_hash == job.request_hash ? Accepted::Kind::existing : Accepted::Kind::conflict;
    return accepted;
}

Accepted SqliteStore::insert(SQLite::Database& database, const NewJob& job) {
    if (!job.idempotency_key.empty())
        if (std::optional<Accepted> earlier = find_by_key(database, job)) return *std::move(earlier);
    {
        Prepared row(database, insert_job_,
                     "INSERT INTO jobs (id, name, status, created_at, timeout_s, request_hash) "
                     "VALUES (?, ?, 'queued', ?, ?, ?)");
        row->bind(1, job.id);
        row->bind(2, job.name);
        row->bind(3, job.created_at);
        row->bind(4, job.timeout_s);
        row->bind(5, job.request_hash);
        row->exec();
    }
    Accepted accepted;
    accepted.job.seq = database.getLastInsertRowid();
    Prepared body(database, insert_request_, "INSERT INTO requests (seq, body) VALUES (?, ?)");
    body->bind(1, accepted.job.seq);
    body->bindNoCopy(2, job.request);
    body->exec();
    if (!job.idempotency_key.empty()) {
        SQLite::Statement key(database, "INSERT INTO idempotency_keys (key, seq) VALUES (?, ?)");
        key.bind(1, job.idempotency_key);
        key.bind(2, accepted.job.seq);
        key.exec();
    }
    accepted.job.id = job.id;
    accepted.job.name = job.name;
    accepted.job.created_at = job.created_at;
    accepted.job.timeout_s = job.timeout_s;
    accepted.job.request_hash = job.request_hash;
    return accepted;
}

void SqliteStore::accept(NewJob job, Done<Accepted> done) {
    write<Accepted>(
        true, [this, job = std::move(job)](SQLite::Database& database) { return insert(database, job); },
        std::move(done));
}

void SqliteStore::claim_next(UnixMs now, Done<std::optional<JobRecord>> done) {
    const auto work = [this, now](SQLite::Database& database) -> std::optional<JobRecord> {
        JobRecord job;
        {
            Prepared row(database, claim_,
                         std::string("UPDATE jobs AS j SET status = 'running', started_at = ?, attempts = attempts + 1 "
                                     "WHERE seq = (SELECT seq FROM jobs WHERE status = 'queued' ORDER BY seq LIMIT 1) "
                                     "RETURNING seq, id, name, status, created_at, started_at, finished_at, attempts, "
                                     "timeout_s, request_hash, cancel_requested"));
            row->bind(1, now);
            if (!row->executeStep()) return std::nullopt;
            static_cast<JobSummary&>(job) = read_summary(*row);
            while (row->executeStep()) {
            }
        }
        Prepared body(database, load_request_, "SELECT body FROM requests WHERE seq = ?");
        body->bind(1, job.seq);
        if (body->executeStep()) job.request = text(*body, 0);
        return job;
    };
    // Not waiting for the disk: after a power cut the job is queued again, which is where it belongs anyway.
    write<std::optional<JobRecord>>(false, work, std::move(done));
}

void SqliteStore::finish(JobEnd end, Done<bool> done) {
    const auto work = [this, end = std::move(end)](SQLite::Database& database) {
        const auto found = status_of(database, end.id);
        if (!found || found->second != JobStatus::running) return false;
        Prepared row(database, end_, "UPDATE jobs SET status = ?, finished_at = ?, version = ? WHERE seq = ?");
        row->bind(1, std::string(to_string(end.status)));
        row->bind(2, end.finished_at);
        row->bind(3, end.version);
        row->bind(4, found->first);
        row->exec();
        if (end.result.empty() && end.error.empty()) return true;
        Prepared result(database, insert_result_, "INSERT INTO results (seq, body, error) VALUES (?, ?, ?)");
        result->bind(1, found->first);
        if (!end.result.empty()) result->bindNoCopy(2, end.result);
        if (!end.error.empty()) result->bindNoCopy(3, end.error);
        result->exec();
        return true;
    };
    write<bool>(true, work, std::move(done));
}

void SqliteStore::release(std::string id, Done<bool> done) {
    const auto work = [id = std::move(id)](SQLite::Database& database) {
        SQLite::Statement row(database, "UPDATE jobs SET status = 'queued' WHERE id = ? AND status = 'running'");
        row.bind(1, id);
        return row.exec() == 1;
    };
    write<bool>(true, work, std::move(done));
}

std::optional<std::pair<std::int64_t, JobStatus>> SqliteStore::status_of(SQLite::Database& database,
                                                                         const std::string& id) {
    Prepared row(database, status_of_, "SELECT seq, status FROM jobs WHERE id = ?");
    row->bind(1, id);
    if (!row->executeStep()) return std::nullopt;
    return std::pair{row->getColumn(0).getInt64(), job_status(text(*row, 1)).value()};
}

void SqliteStore::cancel(std::string id, UnixMs now, Done<CancelEffect> done) {
    const auto work = [this, id = std::move(id), now](SQLite::Database& database) {
        const auto found = status_of(database, id);
        if (!found) return CancelEffect::none;
        if (has_ended(found->second)) return CancelEffect::ended;
        const bool running = found->second == JobStatus::running;
        SQLite::Statement row(database, running ? "UPDATE jobs SET cancel_requested = 1 WHERE seq = ?"
                                                : "UPDATE jobs SET cancel_requested = 1, status = 'cancelled', "
                                                  "finished_at = ?2 WHERE seq = ?1");
        row.bind(1, found->first);
        if (!running) row.bind(2, now);
        row.exec();
        return running ? CancelEffect::requested : CancelEffect::cancelled;
    };
    write<CancelEffect>(true, work, std::move(done));
}

void SqliteStore::remove(std::string id, Done<RemoveEffect> done) {
    const auto work = [this, id = std::move(id)](SQLite::Database& database) {
        const auto found = status_of(database, id);
        if (!found) return RemoveEffect::none;
        if (!has_ended(found->second)) return RemoveEffect::not_ended;
        SQLite::Statement row(database, "DELETE FROM jobs WHERE seq = ?");
        row.bind(1, found->first);
        row.exec();
        return RemoveEffect::removed;
    };
    write<RemoveEffect>(true, work, std::move(done));
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
