#include "server/store/sqlite/connection.h"

namespace tunewright::server {

Connection::Use::~Use() {
    statement_.tryReset();
    try {
        statement_.clearBindings();
    } catch (const SQLite::Exception&) {  // cannot happen after a reset; a destructor must not throw
    }
}

std::string Connection::Use::text(int column) const {
    const SQLite::Column value = statement_.getColumn(column);
    return value.isNull() ? std::string{} : value.getString();
}

std::optional<UnixMs> Connection::Use::moment(int column) const {
    const SQLite::Column value = statement_.getColumn(column);
    return value.isNull() ? std::nullopt : std::optional<UnixMs>(value.getInt64());
}

Connection::Connection(const std::string& path, int flags) : database_(path, flags) {
    wait_for_others(kUsualWait);
    database_.exec("PRAGMA foreign_keys = ON");
}

Connection::Use Connection::use(std::string_view sql) {
    auto found = statements_.find(sql);
    if (found == statements_.end()) {
        std::string text(sql);
        SQLite::Statement statement(database_, text);
        found = statements_.emplace(std::move(text), std::move(statement)).first;
    }
    return Use(found->second);
}

std::int64_t Connection::number(std::string_view sql) {
    Use row = use(sql);
    return row.next() ? row.integer(0) : 0;
}

}  // namespace tunewright::server
