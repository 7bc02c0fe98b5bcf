// A job as it is this moment: what the store keeps, and the progress of one that runs in this process.
#pragma once

#include <optional>

#include "engine/progress.h"
#include "server/store/store.h"

namespace tunewright::server {

struct JobView {
    JobRecord job;
    std::optional<Progress> progress;  ///< of one that runs here; of others job.progress has what was last told
};

}  // namespace tunewright::server
