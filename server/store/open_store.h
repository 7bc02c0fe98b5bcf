// How the service gets its store: the one that an address means, and around it one that measures each operation.
#pragma once

#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <string_view>

#include "server/store/store.h"

namespace tunewright::server {

/// sqlite:PATH or postgresql://USER:PASSWORD@HOST:PORT/DATABASE (or postgres://). Throws std::invalid_argument with a
/// sentence where it is neither; the sentence never has a password in it.
void check_store_address(const std::string& address);

/// Who brings the tables of a store up to date when a newer program comes.
enum class SchemaSteps {
    take,   ///< whoever opens it
    leave,  ///< `tunewright migrate`: until then it cannot be opened
};

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

// ---- the stores themselves (sqlite/, postgres/)

/// Makes the file and its folder where they are not there, and brings the schema up to date or throws SchemaBehind.
/// Throws StoreError with a sentence.
std::unique_ptr<JobStore> open_sqlite_store(const std::string& path, SchemaSteps steps);

/// The schema alone, and `compact`: the file is written anew without the pages that deleted jobs left. Throws
/// StoreError with a sentence, also where a service uses the file.
void migrate_sqlite(const std::string& path, bool compact, std::ostream& out);

/// Connects, and brings the schema `tunewright` of the database up to date or throws SchemaBehind. `uri`:
/// postgresql://user:password@host/name. Where the schema is up to date its user needs no right to change it. Throws
/// StoreError with a sentence that never has the password in it.
std::unique_ptr<JobStore> open_postgres_store(const std::string& uri, SchemaSteps steps, bool pooled = false);

/// The schema alone. `grant` names a role that is given what a service needs: to read and write rows, nothing else.
/// Throws as open_postgres_store() does.
void migrate_postgres(const std::string& uri, const std::string& grant, std::ostream& out);

/// Whether several processes can use it at the same time: true of PostgreSQL alone. The address is not checked.
bool is_shared_store(const std::string& address);

/// `meter` runs on whatever thread the operation ends on: its name, the seconds from the call to the answer, and
/// whether the store could do it.
using StoreMeter = std::function<void(std::string_view operation, double seconds, bool done)>;

std::unique_ptr<JobStore> metered(std::unique_ptr<JobStore> store, StoreMeter meter);

}  // namespace tunewright::server
