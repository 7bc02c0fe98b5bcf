// The service as a whole: puts its parts together, runs them until it is told to stop, takes them down in order.
#pragma once

#include "server/config.h"

namespace tunewright::server {

/// Serves until SIGTERM or SIGINT. Returns the exit code: 0 stopped as asked, 2 for a configuration that cannot be
/// used, 3 where the port or 4 where the store cannot be opened; the sentence is on standard error.
int serve(const Config& config);

}  // namespace tunewright::server
