#include "server/random.h"

#include <sys/random.h>

#include <stdexcept>
#include <string_view>

namespace tunewright::server {

std::vector<unsigned char> random_bytes(std::size_t count) {
    std::vector<unsigned char> bytes(count);
    // At most 256 bytes per call are never returned in part.
    if (count > 256 || ::getrandom(bytes.data(), count, 0) != static_cast<ssize_t>(count))
        throw std::runtime_error("the system gives no random bytes");
    return bytes;
}

std::string random_hex(std::size_t bytes) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string text;
    for (const unsigned char byte : random_bytes(bytes)) {
        text.push_back(digits[byte >> 4]);
        text.push_back(digits[byte & 15]);
    }
    return text;
}

std::string new_id() {
    constexpr std::string_view alphabet = "0123456789abcdefghjkmnpqrstvwxyz";
    std::string id;
    for (const unsigned char byte : random_bytes(26)) id.push_back(alphabet[byte % alphabet.size()]);
    return id;
}

}  // namespace tunewright::server
