// The store in an SQLite file, for one process.
#pragma once

#include <iosfwd>
#include <memory>
#include <string>

#include "server/store/store.h"

namespace tunewright::server {

/// Creates the file and its folder if they do not exist, and migrates the schema or throws SchemaBehind. Throws
/// StoreError with a sentence.
std::unique_ptr<JobStore> open_sqlite_store(const std::string& path, SchemaSteps steps);

/// Migrates the schema only; with `compact`, the file is rewritten without the pages that deleted jobs left. Throws
/// StoreError with a sentence, also if a service uses the file.
void migrate_sqlite(const std::string& path, bool compact, std::ostream& out);

}  // namespace tunewright::server
