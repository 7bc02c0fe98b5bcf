#include "server/json_text.h"

#include <fmt/format.h>

#include <array>
#include <ctime>
#include <iterator>

namespace tunewright::server {

std::string json_string(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out.push_back('\\');
            out.push_back(c);
        } else if (static_cast<unsigned char>(c) < 0x20) {
            fmt::format_to(std::back_inserter(out), "\\u{:04x}", static_cast<unsigned char>(c));
        } else {
            out.push_back(c);
        }
    }
    out.push_back('"');
    return out;
}

JsonObject& JsonObject::raw(std::string_view key, std::string_view json) {
    if (out_.size() > 1) out_.push_back(',');
    out_.append(json_string(key)).append(":").append(json.empty() ? std::string_view{"null"} : json);
    return *this;
}

std::string iso_time(std::int64_t unix_ms) {
    const auto seconds = static_cast<std::time_t>(unix_ms / 1000);
    std::tm utc{};
    gmtime_r(&seconds, &utc);
    std::array<char, 32> date{};
    std::strftime(date.data(), date.size(), "%Y-%m-%dT%H:%M:%S", &utc);
    return fmt::format("{}.{:03}Z", date.data(), unix_ms % 1000);
}

}  // namespace tunewright::server
