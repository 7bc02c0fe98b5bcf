// Jobs in one SQLite file: write-ahead log, one writer, readers on connections of their own.
#pragma once

#include <memory>
#include <string>

#include "server/store/store.h"

namespace tunewright::server {

/// Opens or creates the file (its folder is created too), brings its schema up to date and locks it against a second
/// service. Throws StoreError with a sentence.
std::unique_ptr<JobStore> open_sqlite_store(const std::string& path);

}  // namespace tunewright::server
