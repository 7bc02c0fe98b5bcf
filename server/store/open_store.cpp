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
    if (address.starts_with(kSqlite) && address.size() > kSqlite.size()) return;
    // What looks like user:password@host is not repeated.
    const std::string shown = address.find('@') == std::string::npos ? "\"" + address + "\"" : "no address of a store";
    throw std::invalid_argument("--store is " + shown +
                                "; it must be sqlite:PATH, such as sqlite:tunewright.db, or "
                                "postgresql://USER:PASSWORD@HOST:PORT/DATABASE.");
}

std::unique_ptr<JobStore> open_store(const std::string& address) {
    check_store_address(address);
    if (is_shared_store(address)) return open_postgres_store(address);
    return open_sqlite_store(address.substr(kSqlite.size()));
}

}  // namespace tunewright::server
