// The line of the log for an answered request.
#pragma once

#include "server/http/app/router.h"

namespace tunewright::server::http {

/// One answered request: at the level warn where the status is 500 or more, debug for probes (/healthz, /readyz,
/// /metrics), info otherwise.
void log_answer(const Answered& answered);

}  // namespace tunewright::server::http
