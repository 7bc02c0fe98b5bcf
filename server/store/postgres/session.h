// A connection to PostgreSQL: the address that it goes to, postgresql://user:password@host:port/database?option=value,
// its prepared statements and settings, and errors that say what is to be done.
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

/// The parts of the address that libpq and people need.
class Address {
public:
    /// Throws StoreError with a sentence where `uri` cannot be read; the sentence does not repeat it, since it may
    /// hold a password.
    /// `pooled`: behind a pooler in transaction mode, where nothing lasts from one transaction to the next.
    explicit Address(const std::string& uri, bool pooled = false);

    /// For libpq, with time limits for what the address leaves open: no call waits without end for a machine that is
    /// gone.
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
        broken,    ///< the connection is lost; a new one may do
        conflict,  ///< another transaction was in the way; once more may do
        full,      ///< of disk
        refused,   ///< the statement itself
        unknown,   ///< whether it was committed: the connection was lost and nobody could be asked
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
    Values& text(std::string_view value);  ///< as to_column() makes it
    Values& plain(std::string value);      ///< as it is: literals of arrays, words of our own
    Values& number(std::int64_t value) { return plain(std::to_string(value)); }
    Values& real(double value);
    std::vector<std::string> list;
};

/// An open connection that keeps the server's remarks to itself: what matters comes as an error.
struct Link {
    explicit Link(const Address& address) : connection(address.settings()), quiet(connection) {}
    pqxx::connection connection;
    Quiet quiet;
};

/// Opens a connection with the settings that every part of the store uses; behind a pooler each transaction makes them.
/// Throws Failure.
std::unique_ptr<Link> connect(const Address& address);

class Session {
public:
    /// `line` is told of what is asked and answered; nothing where answers may take as long as they will. Throws
    /// Failure.
    explicit Session(const Address& address, std::shared_ptr<Line> line = nullptr);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// One statement, prepared at its first use; behind a pooler it is sent as it is, in a transaction of its own where
    /// none is open. After the values come `bytes`, as they are, where there are any. Throws Failure.
    pqxx::result run(const std::string& sql, const Values& values = {}, const std::string* bytes = nullptr);
    /// Statements without values, sent in one piece; the result of the last.
    pqxx::result run_plain(const std::string& sql);

    /// A transaction's number, which txid_status() knows even after the connection is lost, within one server_life().
    /// One that is not durable may be undone by a crash of the server, after its commit was answered.
    std::int64_t begin(bool durable = true);
    /// `last` goes ahead of the COMMIT in the same message.
    void commit(const std::string& last = "");
    void rollback();

private:
    template <class Work>
    auto watched(Work work);
    template <class Work>
    pqxx::result guarded(Work work);
    /// The same, in a transaction where one is needed.
    template <class Work>
    pqxx::result sent(Work work);
    const std::string& prepared(const std::string& sql);

    bool pooled_;
    bool open_ = false;  ///< a transaction is
    std::unique_ptr<Link> link_;
    std::shared_ptr<Line> line_;
    std::map<std::string, std::string> names_;  ///< of the prepared statements, by their text
};

/// What an exception of libpqxx means; `open`: the connection still is.
Failure failure_of(const std::exception& error, bool open);

/// As a literal in a statement.
std::string literal(std::string_view text);

}  // namespace tunewright::server::postgres
