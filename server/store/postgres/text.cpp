#include "server/store/postgres/text.h"

#include <algorithm>

namespace tunewright::server::postgres {
namespace {

constexpr char kEscape = '\x01';
constexpr std::string_view kDigits = "0123456789abcdef";

unsigned char at(std::string_view text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

/// Bytes of the character that starts at i; 0 if none does (RFC 3629: shortest form, no surrogates, <= U+10FFFF).
std::size_t character_length(std::string_view text, std::size_t i) {
    const unsigned char first = at(text, i);
    if (first < 0x80) return 1;
    const std::size_t length = first >= 0xc2 && first <= 0xdf   ? 2
                               : first >= 0xe0 && first <= 0xef ? 3
                               : first >= 0xf0 && first <= 0xf4 ? 4
                                                                : 0;
    if (length == 0 || i + length > text.size()) return 0;
    for (std::size_t k = 1; k < length; k++)
        if ((at(text, i + k) & 0xc0) != 0x80) return 0;
    const unsigned char second = at(text, i + 1);
    if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f)) return 0;
    if ((first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f)) return 0;
    return length;
}

int digit(char c) { return static_cast<int>(kDigits.find(c)); }

}  // namespace

std::string to_column(std::string_view text) {
    const auto plain = [](char c) { return c > kEscape; };  // for signed bytes: ASCII other than 0 and 1
    if (std::all_of(text.begin(), text.end(), plain)) return std::string(text);
    std::string column;
    column.reserve(text.size() + 16);
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = character_length(text, i);
        if (length == 0 || at(text, i) <= static_cast<unsigned char>(kEscape)) {
            column += kEscape;
            column += kDigits[at(text, i) >> 4];
            column += kDigits[at(text, i) & 15];
            i++;
        } else {
            column += text.substr(i, length);
            i += length;
        }
    }
    return column;
}

std::string from_column(std::string_view column) {
    if (column.find(kEscape) == std::string_view::npos) return std::string(column);
    std::string text;
    text.reserve(column.size());
    for (std::size_t i = 0; i < column.size(); i++) {
        if (column[i] == kEscape && i + 2 < column.size()) {
            text += static_cast<char>(digit(column[i + 1]) * 16 + digit(column[i + 2]));
            i += 2;
        } else {
            text += column[i];
        }
    }
    return text;
}

void TextArray::add(std::string_view text) {
    if (text_.size() > 1) text_ += ',';
    text_ += '"';
    for (const char c : to_column(text)) {
        if (c == '"' || c == '\\') text_ += '\\';
        text_ += c;
    }
    text_ += '"';
}

void TextArray::add_plain(std::string_view text) {
    if (text_.size() > 1) text_ += ',';
    text_ += text;
}

}  // namespace tunewright::server::postgres
