// The tables of the SQLite store and the numbered steps that lead to them. A step is never edited after a release.
#pragma once

namespace SQLite {
class Database;
}

namespace tunewright::server {

/// Brings the database to the newest schema, one transaction for each step. Throws StoreError where it was written by
/// a newer program.
void migrate(SQLite::Database& database);

}  // namespace tunewright::server
