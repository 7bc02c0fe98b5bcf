#include "api/csv/text.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "api/json/json.h"
#include "api/json/utf8.h"

namespace tunewright::api {
namespace {

void append(std::string& out, std::uint32_t code) {
    const auto byte = [&](std::uint32_t value) { out += static_cast<char>(static_cast<unsigned char>(value)); };
    if (code < 0x80) return byte(code);
    if (code < 0x800) {
        byte(0xC0 | (code >> 6));
    } else if (code < 0x10000) {
        byte(0xE0 | (code >> 12));
        byte(0x80 | ((code >> 6) & 0x3F));
    } else {
        byte(0xF0 | (code >> 18));
        byte(0x80 | ((code >> 12) & 0x3F));
        byte(0x80 | ((code >> 6) & 0x3F));
    }
    byte(0x80 | (code & 0x3F));
}

std::string from_utf16(std::string_view bytes, bool big_endian) {
    std::string out;
    out.reserve(bytes.size());
    const auto unit = [&](std::size_t i) {
        const auto first = static_cast<unsigned char>(bytes[i]), second = static_cast<unsigned char>(bytes[i + 1]);
        return static_cast<std::uint32_t>(big_endian ? first << 8 | second : second << 8 | first);
    };
    for (std::size_t i = 0; i + 1 < bytes.size(); i += 2) {
        std::uint32_t code = unit(i);
        const bool high = code >= 0xD800 && code < 0xDC00;
        if (high && i + 3 < bytes.size() && (unit(i + 2) & 0xFC00) == 0xDC00) {
            code = 0x10000 + ((code - 0xD800) << 10) + (unit(i + 2) - 0xDC00);
            i += 2;
        } else if (code >= 0xD800 && code < 0xE000) {
            code = 0xFFFD;
        }
        append(out, code);
    }
    return out;
}

// Windows-1252 characters in place of the control characters of Latin-1.
constexpr std::array<std::uint16_t, 32> kWindows = {0x20AC, 0xFFFD, 0x201A, 0x0192, 0x201E, 0x2026, 0x2020, 0x2021,
                                                    0x02C6, 0x2030, 0x0160, 0x2039, 0x0152, 0xFFFD, 0x017D, 0xFFFD,
                                                    0xFFFD, 0x2018, 0x2019, 0x201C, 0x201D, 0x2022, 0x2013, 0x2014,
                                                    0x02DC, 0x2122, 0x0161, 0x203A, 0x0153, 0xFFFD, 0x017E, 0x0178};

std::string from_windows(std::string_view bytes) {
    std::string out;
    out.reserve(bytes.size() + bytes.size() / 16);
    for (const char c : bytes) {
        const auto byte = static_cast<unsigned char>(c);
        append(out, byte >= 0x80 && byte < 0xA0 ? kWindows[byte - 0x80U] : byte);
    }
    return out;
}

// True if half of the bytes are zero: texts of a record are mostly ASCII, and so are their UTF-16 forms.
bool zeros_at(std::string_view bytes, std::size_t parity) {
    const std::size_t looked = std::min<std::size_t>(bytes.size() & ~std::size_t{1}, 200);
    std::size_t zeros = 0;
    for (std::size_t i = parity; i < looked; i += 2) zeros += bytes[i] == '\0' ? 1 : 0;
    return looked >= 8 && zeros * 10 >= looked * 4;
}

}  // namespace

std::string encoding_of(std::string_view bytes) {
    const bool little = bytes.substr(0, 2) == "\xFF\xFE", big = bytes.substr(0, 2) == "\xFE\xFF";
    if (big || (!little && zeros_at(bytes, 0))) return "utf-16be";
    if (little || zeros_at(bytes, 1)) return "utf-16le";
    if (is_utf8(bytes)) return "utf-8";
    const bool beyond = std::any_of(bytes.begin(), bytes.end(), [](char c) {
        const auto byte = static_cast<unsigned char>(c);
        return byte >= 0x80 && byte < 0xA0;
    });
    return beyond ? "windows-1252" : "iso-8859-1";
}

std::string_view utf8_text(std::string_view bytes, std::string& storage) {
    if (bytes.substr(0, 3) == "\xEF\xBB\xBF") bytes.remove_prefix(3);
    const std::string encoding = encoding_of(bytes);
    if (encoding == "utf-8") return bytes;
    if (encoding.substr(0, 6) != "utf-16") return storage = from_windows(bytes);
    const bool marked = bytes.substr(0, 2) == "\xFF\xFE" || bytes.substr(0, 2) == "\xFE\xFF";
    return storage = from_utf16(bytes.substr(marked ? 2 : 0), encoding == "utf-16be");
}

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
