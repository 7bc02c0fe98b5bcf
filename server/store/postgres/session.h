// A connection to PostgreSQL: its address, postgresql://user:password@host:port/database?option=value, its prepared
// statements and settings, and errors by the action that they require.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <pqxx/connection>
#include <pqxx/result>
#include <stdexcept>
#include <string>
#include <vector>

#include "server/store/postgres/library.h"
#include "server/store/postgres/watch.h"
#include "server/store/store.h"

namespace tunewright::server::postgres {

/// The parts of the address for libpq and for messages.
class Address {
public:
    /// Throws StoreError with a sentence if `uri` cannot be read; the sentence does not repeat it, since it may contain
    /// a password. `pooled`: behind a pooler in transaction mode, where no state lasts from one transaction to the
    /// next.
    explicit Address(const std::string& uri, bool pooled = false);

    /// For libpq, with timeouts where the address has none: no call waits indefinitely for a machine that is gone.
    const std::string& settings() const { return settings_; }
    /// Host, port and database, for logs and errors: never user or password.
    const std::string& shown() const { return shown_; }
    bool pooled() const { return pooled_; }

private:
    std::string settings_;
    std::string shown_;
    bool pooled_;
};

class Failure : public std::runtime_error {
public:
    enum class Kind {
        broken,    ///< the connection is lost; a new one may work
        conflict,  ///< another transaction interfered; a repetition may work
        full,      ///< the disk is full
        refused,   ///< the statement itself was refused
        unknown,   ///< it is not known whether it was committed: the connection was lost and could not be replaced
    };
    Failure(Kind what, const std::string& detail) : std::runtime_error(detail), kind(what) {}
    StoreFault fault() const {
        const auto said = kind == Kind::full      ? StoreFault::Kind::full
                          : kind == Kind::unknown ? StoreFault::Kind::unknown
                                                  : StoreFault::Kind::unavailable;
        return {said, what()};
    }
    Kind kind;
};

/// Values for $1, $2, ... of a statement, in their order.
class Values {
public:
    Values& text(std::string_view value);  ///< converted by to_column()
    Values& plain(std::string value);      ///< unchanged: literals of arrays, fixed words
    Values& number(std::int64_t value) { return plain(std::to_string(value)); }
    Values& real(double value);
    std::vector<std::string> list;
};

/// An open connection without the server's notices: errors are exceptions.
struct Link {
    explicit Link(const Address& address) : connection(address.settings()), quiet(connection) {}
    pqxx::connection connection;
    Quiet quiet;
};

/// Opens a connection with the settings that every part of the store uses; behind a pooler each transaction sets them.
/// Throws Failure.
std::unique_ptr<Link> connect(const Address& address);

class Session {
public:
    /// `line` is notified of each call and its answer; null if answers have no time limit. Throws Failure.
    explicit Session(const Address& address, std::shared_ptr<Line> line = nullptr);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// Runs one statement, prepared at its first use; behind a pooler it is sent without preparation, in a transaction
    /// of its own if none is open. `bytes`, if any, follow the values unchanged. Throws Failure.
    pqxx::result run(const std::string& sql, const Values& values = {}, const std::string* bytes = nullptr);
    /// Statements without values, sent in one piece; the result of the last.
    pqxx::result run_plain(const std::string& sql);

    /// Begins a transaction and returns its number, which txid_status() knows even after the connection is lost, within
    /// one server_life(). A crash of the server may undo one that is not durable, after its commit was answered.
    std::int64_t begin(bool durable = true);
    /// `last` is sent before the COMMIT in the same message.
    void commit(const std::string& last = "");
    void rollback();

private:
    template <class Work>
    auto watched(Work work);
    template <class Work>
    pqxx::result guarded(Work work);
    /// Runs `work`, in a transaction if one is needed.
    template <class Work>
    pqxx::result sent(Work work);
    const std::string& prepared(const std::string& sql);

    bool pooled_;
    bool open_ = false;  ///< a transaction is open
    std::unique_ptr<Link> link_;
    std::shared_ptr<Line> line_;
    std::map<std::string, std::string> names_;  ///< of the prepared statements, by their text
};

/// The failure for an exception of libpqxx; `open`: the connection is still open.
Failure failure_of(const std::exception& error, bool open);

/// The text as a literal in a statement.
std::string literal(std::string_view text);

}  // namespace tunewright::server::postgres
