// The store in a database of PostgreSQL, for several processes.
#pragma once

#include <iosfwd>
#include <memory>
#include <string>

#include "server/store/store.h"

namespace tunewright::server {

/// Connects, and brings the schema `tunewright` of the database up to date or throws SchemaBehind. `uri`:
/// postgresql://user:password@host/name. Where the schema is up to date its user needs no right to change it. Throws
/// StoreError with a sentence that never has the password in it.
std::unique_ptr<JobStore> open_postgres_store(const std::string& uri, SchemaSteps steps, bool pooled = false);

/// The schema alone. `grant` names a role that is given what a service needs: to read and write rows, nothing else.
/// Throws as open_postgres_store() does.
void migrate_postgres(const std::string& uri, const std::string& grant, std::ostream& out);

}  // namespace tunewright::server
