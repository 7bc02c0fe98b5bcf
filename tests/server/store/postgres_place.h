// A database for one test, on the cluster that TUNEWRIGHT_TEST_POSTGRES names (tests/server/postgres.py).
#pragma once

#include <memory>
#include <string>

namespace tunewright::server {

class PostgresDatabase {
public:
    /// Null if no cluster is named.
    static std::unique_ptr<PostgresDatabase> make();
    ~PostgresDatabase();
    PostgresDatabase(const PostgresDatabase&) = delete;
    PostgresDatabase& operator=(const PostgresDatabase&) = delete;

    const std::string& url() const { return url_; }
    /// Runs statements in it; the first column of the first row of the last one, "" if there is none. Throws the errors
    /// of PostgreSQL.
    std::string run(const std::string& sql) const;
    /// Ends every connection to it.
    void cut_connections() const;
    /// Allows or forbids connections; false also ends every existing one.
    void allow_connections(bool allowed) const;

private:
    PostgresDatabase(std::string cluster, std::string name);
    std::string cluster_;
    std::string name_;
    std::string url_;
};

}  // namespace tunewright::server
