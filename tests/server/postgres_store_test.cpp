#include "server/store/postgres/postgres_store.h"

#include <condition_variable>
#include <mutex>
#include <thread>

#include "tests/server/postgres_place.h"
#include "tests/server/store_conformance.h"

namespace tunewright::server {
namespace {

class PostgresPlace : public StorePlace {
public:
    explicit PostgresPlace(std::unique_ptr<PostgresDatabase> database) : database_(std::move(database)) {}
    std::unique_ptr<JobStore> open() override { return open_postgres_store(database_->url()); }

private:
    std::unique_ptr<PostgresDatabase> database_;
};

std::unique_ptr<StorePlace> postgres_place() {
    std::unique_ptr<PostgresDatabase> database = PostgresDatabase::make();
    if (!database) return nullptr;
    return std::make_unique<PostgresPlace>(std::move(database));
}

INSTANTIATE_TEST_SUITE_P(Postgres, StoreConformance, testing::Values(MakePlace(postgres_place)));

}  // namespace
}  // namespace tunewright::server
