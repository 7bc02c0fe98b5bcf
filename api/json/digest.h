// SHA-256 (FIPS 180-4) of a text: names a request in results.
#pragma once

#include <string>
#include <string_view>

namespace tunewright::api {

/// 64 hexadecimal digits.
std::string sha256_hex(std::string_view text);

}  // namespace tunewright::api
