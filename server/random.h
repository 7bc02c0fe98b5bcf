// Bits that nobody can guess, from the system: names of jobs and processes, keys.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tunewright::server {

/// Throws std::runtime_error where the system gives none.
std::vector<unsigned char> random_bytes(std::size_t count);

/// So many bytes as twice as many lower-case hexadecimal digits.
std::string random_hex(std::size_t bytes);

}  // namespace tunewright::server
