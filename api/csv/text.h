// Bytes of a file as UTF-8 text, and the text line by line.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace tunewright::api {

/// The whole content of a file as UTF-8 without byte order mark. `bytes` may be UTF-8, or UTF-16 with a byte order mark
/// or with every other byte zero (spreadsheets' "Unicode text"); any other bytes are read as Windows-1252. Returns
/// `bytes` itself if nothing has to be changed; otherwise `storage` holds the text and must outlive the result.
std::string_view utf8_text(std::string_view bytes, std::string& storage);

/// The encoding with which utf8_text reads the bytes, by its name in browsers' decoders: "utf-8", "utf-16le",
/// "utf-16be", "windows-1252", or "iso-8859-1" if it has only letters of Latin-1.
std::string encoding_of(std::string_view bytes);

/// The line that begins at offset `at`, without its line end; `at` is then moved to the next line. \n, \r\n and \r end
/// a line, and so does the end of the text. Returns nothing if `at` is at the end of the text:
///
///     std::string storage;
///     const std::string_view text = utf8_text(bytes, storage);
///     std::size_t at = 0;
///     while (const auto line = next_line(text, at)) ...
std::optional<std::string_view> next_line(std::string_view text, std::size_t& at);

/// ASCII only, independent of the locale.
constexpr bool is_digit(char c) { return c >= '0' && c <= '9'; }

}  // namespace tunewright::api
