// The tables of the PostgreSQL database, the numbered migration steps, and the rights of roles.
#pragma once

#include <string>

#include "server/store/postgres/session.h"

namespace tunewright::server::postgres {

/// Throws Failure, or StoreError with a sentence if the database is not suitable or was written by a newer program.
SchemaState schema_state(Session& session);
/// Migrates the database to the newest schema by the numbered steps of schema.cpp, in one transaction and one process
/// at a time: replicas may start together. A step is never edited after a release. Throws like schema_state().
void migrate(Session& session);
/// A word that changes when the server crashes: after that it may give a transaction's number a second time. Throws
/// Failure.
std::string server_life(Session& session);
/// Grants the rights of a service to a role that may not change the schema.
void grant_use(Session& session, const std::string& role);

}  // namespace tunewright::server::postgres
