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

/// Names a job, a batch or a process: 130 random bits as 26 letters and digits.
std::string new_id();

}  // namespace tunewright::server
