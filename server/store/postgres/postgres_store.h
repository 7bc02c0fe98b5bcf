// The store in a database of PostgreSQL, for several processes.
#pragma once

#include <iosfwd>
#include <memory>
#include <string>

#include "server/store/store.h"

namespace tunewright::server {

/// Connects, and migrates the schema `tunewright` of the database or throws SchemaBehind. `uri`:
/// postgresql://user:password@host/name. The user needs rights to change the schema only for a migration. Throws
/// StoreError with a sentence that never contains the password.
std::unique_ptr<JobStore> open_postgres_store(const std::string& uri, SchemaSteps steps, bool pooled = false);

/// Migrates the schema only. `grant` names a role that gets the rights of a service: to read and write rows, nothing
/// else. Throws like open_postgres_store().
void migrate_postgres(const std::string& uri, const std::string& grant, std::ostream& out);

}  // namespace tunewright::server
