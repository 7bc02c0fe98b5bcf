// A batch as the contract shows it.
#pragma once

#include <string>

#include "server/store/store.h"

namespace tunewright::server {

std::string batch_json(const BatchSummary& batch);

/// {"batches": [...], "next": "/v1/batches?..." or null}
std::string batch_page_json(const BatchPage& page, int limit);

}  // namespace tunewright::server
