// The checks of a batch, read for their common judgement.
#pragma once

#include <string>
#include <variant>

#include "api/batch/plant_checks.h"
#include "server/http/message.h"
#include "server/jobs/batch/batches.h"

namespace tunewright::server {

struct BatchOfChecks {
    BatchSummary batch;
    api::PlantChecks checks;  ///< of the entries that have ended
};

/// Reads them, or refuses: 404 without such a batch, 422 for one that is too large, 409 for one that has ended without
/// a checked loop. Throws StoreError.
std::variant<BatchOfChecks, http::Response> read_checks(Batches& batches, const http::Request& request,
                                                        const std::string& id,
                                                        api::PlantChecks::Kept kept = api::PlantChecks::Kept::trend);

}  // namespace tunewright::server
