// UTF-8: validity of bytes, and boundaries of characters.
#pragma once

#include <cstddef>
#include <string_view>

namespace tunewright::api {

/// Number of bytes at the start of `text` that are valid UTF-8 (RFC 3629): overlong forms, surrogates and code points
/// above U+10FFFF are not valid, and neither is a sequence that the end cuts off.
std::size_t valid_utf8(std::string_view text);

inline bool is_utf8(std::string_view text) { return valid_utf8(text) == text.size(); }

/// The first `bytes` of UTF-8, shortened to whole characters.
std::string_view whole_characters(std::string_view text, std::size_t bytes);

}  // namespace tunewright::api
