// Bytes of a file as UTF-8 text.
#pragma once

#include <string>
#include <string_view>

namespace tunewright::api {

/// UTF-8 without byte order mark. `bytes` may be UTF-8, UTF-16 with a byte order mark or with every other byte zero
/// (spreadsheets' "Unicode text"), else they are taken for Windows-1252. Returns `bytes` itself where nothing has to
/// be changed; `storage` holds the text otherwise.
std::string_view utf8_text(std::string_view bytes, std::string& storage);

bool is_utf8(std::string_view text);

}  // namespace tunewright::api
