// Converts any bytes to texts of PostgreSQL, and back.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tunewright::server::postgres {

/// Texts of PostgreSQL are valid UTF-8 without zero bytes. Every other byte, and the byte 1 itself, becomes the byte 1
/// and two hexadecimal digits: the conversion is reversible for any bytes, and equal texts stay equal.
std::string to_column(std::string_view text);
/// The bytes from which to_column() made `column`.
std::string from_column(std::string_view column);

/// The literal of a text[] of these texts, each converted by to_column(): {} of none, {"a","b \"c\""} of two. One
/// parameter of a statement then carries any number of texts.
class TextArray {
public:
    /// Adds any bytes.
    void add(std::string_view text);
    /// Adds a number or a word that needs neither quotes nor to_column().
    void add_plain(std::string_view text);
    std::string literal() const { return text_ + "}"; }

private:
    std::string text_ = "{";
};

}  // namespace tunewright::server::postgres
