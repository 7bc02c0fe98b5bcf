// Opens the store of an address.
#pragma once

#include <iosfwd>
#include <memory>
#include <string>

#include "server/store/store.h"

namespace tunewright::server {

/// sqlite:PATH or postgresql://USER:PASSWORD@HOST:PORT/DATABASE (or postgres://). Throws std::invalid_argument with a
/// sentence if the address has neither form; the sentence never contains a password.
void check_store_address(const std::string& address);

/// Opens the store and migrates its schema, or throws SchemaBehind; a missing SQLite file is created with its folder.
/// Throws like check_store_address(), and StoreError with a sentence:
///
///     const auto store = open_store("sqlite:tunewright.db");
///
/// `pooled`: PostgreSQL is behind a pooler in transaction mode. No state is kept in a session then, and changes by
/// other processes are polled, because there are no notices.
std::unique_ptr<JobStore> open_store(const std::string& address, SchemaSteps steps = SchemaSteps::take,
                                     bool pooled = false);

struct MigrateCommand {
    std::string store;
    std::string grant;     ///< a role of PostgreSQL that gets the rights of a service; "": none
    bool compact = false;  ///< returns unused space of a SQLite file to the system
};

/// `tunewright migrate`: migrates the schema, however long that takes, and reports the steps. Throws like open_store().
void migrate_store(const MigrateCommand& command, std::ostream& out);

/// True if several processes can use it at the same time, which is true of PostgreSQL only. The address is not checked.
bool is_shared_store(const std::string& address);

}  // namespace tunewright::server
