#include "server/store/open_store.h"

#include <stdexcept>
#include <string_view>

#include "server/store/postgres/postgres_store.h"
#include "server/store/sqlite/sqlite_store.h"

namespace tunewright::server {
namespace {

constexpr std::string_view kSqlite = "sqlite:";

}  // namespace

bool is_shared_store(const std::string& address) {
    return address.starts_with("postgresql://") || address.starts_with("postgres://");
}

void check_store_address(const std::string& address) {
    if (is_shared_store(address)) return;
    if (address == "sqlite::memory:" || address.starts_with("sqlite:file:"))
        throw std::invalid_argument("--store is \"" + address +
                                    "\"; it must name a file, such as sqlite:tunewright.db, so that several "
                                    "connections and the next start find the same jobs.");
    if (address.starts_with(kSqlite) && address.size() > kSqlite.size()) return;
    // A text with the form user:password@host is not repeated.
    const std::string shown =
        address.find('@') == std::string::npos ? "\"" + address + "\"" : "not the address of a store";
    throw std::invalid_argument("--store is " + shown +
                                "; it must be sqlite:PATH, such as sqlite:tunewright.db, or "
                                "postgresql://USER:PASSWORD@HOST:PORT/DATABASE.");
}

std::unique_ptr<JobStore> open_store(const std::string& address, SchemaSteps steps, bool pooled) {
    check_store_address(address);
    if (is_shared_store(address)) return open_postgres_store(address, steps, pooled);
    return open_sqlite_store(address.substr(kSqlite.size()), steps);
}

void migrate_store(const MigrateCommand& command, std::ostream& out) {
    check_store_address(command.store);
    const bool shared = is_shared_store(command.store);
    if (shared && command.compact)
        throw std::invalid_argument(
            "--compact is for SQLite; PostgreSQL returns space by itself, and VACUUM FULL all of it.");
    if (!shared && !command.grant.empty())
        throw std::invalid_argument(
            "--grant is for PostgreSQL; the access to a SQLite file follows from its permissions.");
    if (shared) return migrate_postgres(command.store, command.grant, out);
    migrate_sqlite(command.store.substr(kSqlite.size()), command.compact, out);
}

}  // namespace tunewright::server
