// The service as a whole: constructs its parts, runs them until a signal, and destroys them in order.
#pragma once

#include "server/config.h"

namespace tunewright::server {

/// Exit codes of a process whose configuration, port or store cannot be used.
constexpr int kBadConfiguration = 2, kPortFailed = 3, kStoreFailed = 4;

/// Serves until SIGTERM or SIGINT; a second signal ends the process at once. Returns 0 after a normal stop; otherwise
/// one of those codes, with the reason on standard error.
int serve(Config config);

}  // namespace tunewright::server
