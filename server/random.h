// Random bits from the system that cannot be guessed: names of jobs and processes, keys.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tunewright::server {

/// Throws std::runtime_error if the system has none.
std::vector<unsigned char> random_bytes(std::size_t count);

/// This number of bytes as twice as many lower-case hexadecimal digits.
std::string random_hex(std::size_t bytes);

/// A name for a job, a batch or a process: 130 random bits as 26 letters and digits.
std::string new_id();

}  // namespace tunewright::server
