// A connection to the SQLite file with its prepared statements: each is compiled once.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "server/store/store.h"

namespace tunewright::server {

constexpr std::chrono::milliseconds kUsualWait{5000};

class Connection {
public:
    /// A prepared statement in use; its destructor resets it. A statement must not be in use twice at a time.
    class Use {
    public:
        explicit Use(SQLite::Statement& statement) : statement_(statement) {}
        ~Use();
        Use(const Use&) = delete;
        Use& operator=(const Use&) = delete;

        /// Values for ?1, ?2, ...; texts must outlive this object.
        template <class... Values>
        Use& with(const Values&... values) {
            int place = 0;
            (bind(++place, values), ...);
            return *this;
        }
        void bind(int place, const std::string& value) { statement_.bindNoCopy(place, value); }
        void bind(int place, const char* value) { statement_.bind(place, value); }
        void bind(int place, std::int64_t value) { statement_.bind(place, value); }
        void bind(int place, int value) { statement_.bind(place, value); }
        void bind(int place, double value) { statement_.bind(place, value); }
        void bind_null(int place) { statement_.bind(place); }

        /// True if there is a (further) row.
        bool next() { return statement_.executeStep(); }
        /// For a statement that returns no rows: the number of changed rows.
        int run() { return statement_.exec(); }

        /// Columns from 0; null is read as "", 0 or empty.
        std::string text(int column) const;
        std::int64_t integer(int column) const { return statement_.getColumn(column).getInt64(); }
        double real(int column) const { return statement_.getColumn(column).getDouble(); }
        std::optional<UnixMs> moment(int column) const;

    private:
        SQLite::Statement& statement_;
    };

    Connection(const std::string& path, int flags);

    Use use(std::string_view sql);
    /// The only value of the only row.
    std::int64_t number(std::string_view sql);
    SQLite::Database& database() { return database_; }
    /// The time that a statement waits for other connections.
    void wait_for_others(std::chrono::milliseconds patience) {
        database_.setBusyTimeout(static_cast<int>(patience.count()));
    }

private:
    SQLite::Database database_;
    std::map<std::string, SQLite::Statement, std::less<>> statements_;
};

}  // namespace tunewright::server
