// The text that a command line names.
#pragma once

#include <string>

namespace tunewright::server {

/// All of the file, or of standard input for "-". False where it cannot be read.
bool read_input(const std::string& file, std::string& text);

}  // namespace tunewright::server
