// UTF-8: whether bytes are it, and where its characters end.
#pragma once

#include <cstddef>
#include <string_view>

namespace tunewright::api {

/// How many bytes `text` begins with that belong to valid UTF-8 sequences (RFC 3629): overlong forms, surrogates and
/// what lies above U+10FFFF are not valid, and neither is a sequence that the end cuts off.
std::size_t valid_utf8(std::string_view text);

inline bool is_utf8(std::string_view text) { return valid_utf8(text) == text.size(); }

/// The first `bytes` of UTF-8, or as many of them as hold whole characters.
std::string_view whole_characters(std::string_view text, std::size_t bytes);

}  // namespace tunewright::api
