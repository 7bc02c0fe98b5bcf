// The service as a whole: puts its parts together, runs them until a signal asks it to stop, takes them down in order.
#pragma once

#include "server/config.h"

namespace tunewright::server {

/// How a process ends whose configuration, port or store cannot be used.
constexpr int kBadConfiguration = 2, kPortFailed = 3, kStoreFailed = 4;

/// Serves until SIGTERM or SIGINT; a second signal ends the process at once. Returns 0 where it stopped as asked;
/// one of those codes where not, and standard error has the sentence that says why.
int serve(Config config);

}  // namespace tunewright::server
