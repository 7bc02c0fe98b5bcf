// The store in a file of SQLite, for one process.
#pragma once

#include <iosfwd>
#include <memory>
#include <string>

#include "server/store/store.h"

namespace tunewright::server {

/// Makes the file and its folder where they are not there, and brings the schema up to date or throws SchemaBehind.
/// Throws StoreError with a sentence.
std::unique_ptr<JobStore> open_sqlite_store(const std::string& path, SchemaSteps steps);

/// The schema alone, and `compact`: the file is written anew without the pages that deleted jobs left. Throws
/// StoreError with a sentence, also where a service uses the file.
void migrate_sqlite(const std::string& path, bool compact, std::ostream& out);

}  // namespace tunewright::server
