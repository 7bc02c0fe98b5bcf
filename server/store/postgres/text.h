// Any bytes as texts of PostgreSQL, and back.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace tunewright::server::postgres {

/// PostgreSQL's texts hold valid UTF-8 without zero bytes. Every other byte, and the byte 1 itself, becomes the byte 1
/// and two hexadecimal digits: any bytes go in and come out again, and equal texts stay equal.
std::string to_column(std::string_view text);
/// The bytes that to_column() made `column` of.
std::string from_column(std::string_view column);

/// The literal of a text[] of these texts, each as to_column() makes it: {} of none, {"a","b \"c\""} of two. One
/// parameter of a statement then carries any number of texts.
class TextArray {
public:
    /// Any bytes.
    void add(std::string_view text);
    /// A number, a word: something that needs neither quotes nor to_column().
    void add_plain(std::string_view text);
    std::string literal() const { return text_ + "}"; }

private:
    std::string text_ = "{";
};

}  // namespace tunewright::server::postgres
