// A text line by line.
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

namespace tunewright::api {

/// The line that begins at `at`, which moves behind it; \n, \r\n and \r end one. Empty at the end of the text.
std::optional<std::string_view> next_line(std::string_view text, std::size_t& at);

}  // namespace tunewright::api
