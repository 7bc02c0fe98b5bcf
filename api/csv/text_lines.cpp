#include "api/csv/text_lines.h"

#include <algorithm>

namespace tunewright::api {

std::optional<std::string_view> next_line(std::string_view text, std::size_t& at) {
    if (at >= text.size()) return std::nullopt;
    const std::size_t newline = std::min(text.find('\n', at), text.size());
    const std::size_t end = std::min(at + std::min(text.substr(at, newline - at).find('\r'), newline - at), newline);
    const std::string_view line = text.substr(at, end - at);
    at = end + 1;
    if (end + 1 < text.size() && text[end] == '\r' && text[end + 1] == '\n') ++at;
    return line;
}

}  // namespace tunewright::api
