// `tunewright health [URL]`: asks a running service whether it is well, for health checks where there is no curl.
#pragma once

#include <string>

namespace tunewright::server {

/// GET `url` (http://HOST:PORT/PATH, HOST an address or a name), answered within three seconds. Returns 0 where the
/// status is 200; else 1, and standard error says why. 2 where the url cannot be used.
int check_health(const std::string& url);

/// http://HOST:PORT/healthz for what --listen says; loopback where it says every address.
std::string health_url(const std::string& listen);

}  // namespace tunewright::server
