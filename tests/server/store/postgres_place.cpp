#include "tests/server/store/postgres_place.h"

#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <pqxx/pqxx>

namespace tunewright::server {
namespace {

std::string run_at(const std::string& url, const std::string& sql) {
    pqxx::connection connection(url);
    const pqxx::result rows = pqxx::nontransaction(connection).exec(sql);
    return rows.empty() || rows[0][0].is_null() ? "" : rows[0][0].c_str();
}

}  // namespace

std::unique_ptr<PostgresDatabase> PostgresDatabase::make() {
    static std::atomic<int> count = 0;
    const char* cluster = std::getenv("TUNEWRIGHT_TEST_POSTGRES");
    if (cluster == nullptr || *cluster == '\0') return nullptr;
    const std::string name = "test_" + std::to_string(::getpid()) + "_" + std::to_string(count++);
    return std::unique_ptr<PostgresDatabase>(new PostgresDatabase(cluster, name));
}

PostgresDatabase::PostgresDatabase(std::string cluster, std::string name)
    : cluster_(std::move(cluster)), name_(std::move(name)), url_(cluster_) {
    run_at(cluster_, "CREATE DATABASE " + name_);
    url_.replace(url_.rfind('/') + 1, std::string::npos, name_);
}

PostgresDatabase::~PostgresDatabase() {
    try {
        run_at(cluster_, "DROP DATABASE " + name_ + " WITH (FORCE)");
    } catch (const std::exception&) {  // the whole cluster is removed anyway
    }
}

std::string PostgresDatabase::run(const std::string& sql) const { return run_at(url_, sql); }

void PostgresDatabase::cut_connections() const {
    run_at(cluster_, "SELECT pg_terminate_backend(pid) FROM pg_stat_activity WHERE datname = '" + name_ + "'");
}

void PostgresDatabase::allow_connections(bool allowed) const {
    run_at(cluster_, "ALTER DATABASE " + name_ + " WITH ALLOW_CONNECTIONS " + (allowed ? "true" : "false"));
    if (!allowed) cut_connections();
}

}  // namespace tunewright::server
