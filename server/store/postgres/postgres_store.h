// Jobs in PostgreSQL, for any number of processes at the same time.
#pragma once

#include <memory>
#include <string>

#include "server/store/store.h"

namespace tunewright::server {

/// Connects, and brings the schema `tunewright` of the database up to date. `uri`:
/// postgresql://user:password@host/name. Throws StoreError with a sentence that never has the password in it.
std::unique_ptr<JobStore> open_postgres_store(const std::string& uri);

}  // namespace tunewright::server
