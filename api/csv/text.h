// Bytes of a file as UTF-8 text, and the text line by line.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace tunewright::api {

/// UTF-8 without byte order mark. `bytes` may be UTF-8, or UTF-16 with a byte order mark or with every other byte zero
/// (spreadsheets' "Unicode text"); any other bytes are read as Windows-1252. Returns `bytes` itself where nothing has
/// to be changed; otherwise `storage` holds the text and must outlive the result.
std::string_view utf8_text(std::string_view bytes, std::string& storage);

/// Whether every byte belongs to a valid UTF-8 sequence.
bool is_utf8(std::string_view text);

/// The line that begins at offset `at`, which is then moved to the next line. \n, \r\n and \r end a line. Returns
/// nothing at the end of the text.
std::optional<std::string_view> next_line(std::string_view text, std::size_t& at);

}  // namespace tunewright::api
