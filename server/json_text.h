// Writes small JSON objects around texts that are already JSON, without parsing them again.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace tunewright::server {

/// The text in quotes, escaped. UTF-8 passes as it is.
std::string json_string(std::string_view text);

class JsonObject {
public:
    JsonObject& text(std::string_view key, std::string_view value) { return raw(key, json_string(value)); }
    JsonObject& number(std::string_view key, std::int64_t value) { return raw(key, std::to_string(value)); }
    JsonObject& boolean(std::string_view key, bool value) { return raw(key, value ? "true" : "false"); }
    JsonObject& null(std::string_view key) { return raw(key, "null"); }
    /// `json` is one JSON value; an empty text becomes null.
    JsonObject& raw(std::string_view key, std::string_view json);
    std::string str() && { return std::move(out_.append("}")); }

private:
    std::string out_ = "{";
};

/// "2024-05-01T12:00:00.123Z"
std::string iso_time(std::int64_t unix_ms);

}  // namespace tunewright::server
