// The tables of the PostgreSQL store and the numbered steps that lead to them. A step is never edited after a release.
#pragma once

#include "server/store/postgres/session.h"

namespace tunewright::server::postgres {

/// Brings the database to the newest schema, in one transaction and one process at a time: replicas may start
/// together. Throws Failure, or StoreError with a sentence where the database is not fit.
void migrate(Session& session);

}  // namespace tunewright::server::postgres
