// The service as a whole: puts its parts together, runs them until a signal asks it to stop, takes them down in order.
#pragma once

#include "server/config.h"

namespace tunewright::server {

/// Serves until SIGTERM or SIGINT; a second signal ends the process at once. Returns the exit code:
///   0  stopped as asked
///   2  the configuration cannot be used
///   3  the port cannot be opened
///   4  the store cannot be opened
/// In the last three cases standard error has the sentence that says why.
int serve(const Config& config);

}  // namespace tunewright::server
