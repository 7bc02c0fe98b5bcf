// SHA-256 (FIPS 180-4) of a text: names a request in results.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace tunewright::api {

/// Of a text that comes in pieces.
class Sha256 {
public:
    void update(std::string_view piece);
    /// 64 hexadecimal digits of all pieces together.
    std::string hex() const;

private:
    std::array<std::uint32_t, 8> state_ = {0x6a09e667, 0xbb67ae85, 0x3c6ef372, 0xa54ff53a,
                                           0x510e527f, 0x9b05688c, 0x1f83d9ab, 0x5be0cd19};
    std::array<unsigned char, 64> rest_{};
    std::uint64_t length_ = 0;
};

/// 64 hexadecimal digits.
std::string sha256_hex(std::string_view text);

}  // namespace tunewright::api
