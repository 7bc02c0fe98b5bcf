#include "api/json/utf8.h"

#include <cstdint>
#include <cstring>

namespace tunewright::api {
namespace {

// The length of the UTF-8 sequence at `at`; 0 if it is not valid.
std::size_t sequence(std::string_view text, std::size_t at) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char lead = byte(at);
    const std::size_t length = lead < 0x80 ? 1 : lead >= 0xC2 && lead < 0xE0 ? 2 : lead >= 0xE0 && lead < 0xF0 ? 3 : 4;
    if (length == 1) return 1;
    if (lead < 0xC2 || lead > 0xF4 || at + length > text.size()) return 0;
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(at + i) & 0xC0) != 0x80) return 0;
    }
    if ((lead == 0xE0 && byte(at + 1) < 0xA0) || (lead == 0xED && byte(at + 1) > 0x9F) ||
        (lead == 0xF0 && byte(at + 1) < 0x90) || (lead == 0xF4 && byte(at + 1) > 0x8F))
        return 0;
    return length;
}

// True if the eight bytes from `at` on are ASCII, as nearly all of a record are.
bool eight_plain(std::string_view text, std::size_t at) {
    std::uint64_t bytes = 0;
    if (at + sizeof bytes > text.size()) return false;
    std::memcpy(&bytes, text.data() + at, sizeof bytes);
    return (bytes & 0x8080808080808080U) == 0;
}

}  // namespace

std::size_t valid_utf8(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
        if (eight_plain(text, at)) {
            at += 8;
            continue;
        }
        const std::size_t length = sequence(text, at);
        if (length == 0) return at;
        at += length;
    }
    return text.size();
}

std::string_view whole_characters(std::string_view text, std::size_t bytes) {
    if (text.size() <= bytes) return text;
    while (bytes > 0 && (static_cast<unsigned char>(text[bytes]) & 0xC0) == 0x80) --bytes;
    return text.substr(0, bytes);
}

}  // namespace tunewright::api
