// The tables of the SQLite file, and the numbered migration steps.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include "server/store/store.h"

namespace tunewright::server {

/// Throws StoreError if the database was written by a newer program.
SchemaState schema_state(SQLite::Database& database);
/// Migrates the database to the newest schema by the numbered steps of schema.cpp, one transaction for each; a step is
/// never edited after a release. Throws like schema_state().
void migrate(SQLite::Database& database);

}  // namespace tunewright::server
