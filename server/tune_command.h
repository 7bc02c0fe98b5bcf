// `tunewright tune`: one tuning request without a server.
#pragma once

#include <string>

namespace tunewright::server {

/// Reads the request from the file ("-": standard input). The result goes to standard output and 0 is returned; a
/// problem goes to standard error as problem JSON and 1 is returned.
int tune(const std::string& file);

}  // namespace tunewright::server
