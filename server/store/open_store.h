// How the service gets its store: the one that an address means.
#pragma once

#include <iosfwd>
#include <memory>
#include <string>

#include "server/store/store.h"

namespace tunewright::server {

/// sqlite:PATH or postgresql://USER:PASSWORD@HOST:PORT/DATABASE (or postgres://). Throws std::invalid_argument with a
/// sentence where it is neither; the sentence never has a password in it.
void check_store_address(const std::string& address);

/// Opens it and brings its schema up to date, or throws SchemaBehind; a SQLite file that is not there is created with
/// its folder. Throws as check_store_address() does, and StoreError with a sentence:
///
///     const auto store = open_store("sqlite:tunewright.db");
///
/// `pooled`: PostgreSQL is behind a pooler in transaction mode. Nothing is kept in a session then, and what other
/// processes have done is looked for instead of heard of.
std::unique_ptr<JobStore> open_store(const std::string& address, SchemaSteps steps = SchemaSteps::take,
                                     bool pooled = false);

struct MigrateCommand {
    std::string store;
    std::string grant;     ///< a role of PostgreSQL that is given what a service needs; "": none
    bool compact = false;  ///< returns to the system what a SQLite file has no use for any more
};

/// `tunewright migrate`: brings the schema up to date, however long that takes, and says what was done. Throws as
/// open_store() does.
void migrate_store(const MigrateCommand& command, std::ostream& out);

/// Whether several processes can use it at the same time: true of PostgreSQL alone. The address is not checked.
bool is_shared_store(const std::string& address);

}  // namespace tunewright::server
