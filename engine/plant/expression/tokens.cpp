#include "engine/plant/expression/tokens.h"

#include <algorithm>
#include <charconv>
#include <cstdio>

namespace tunewright {
namespace {

constexpr std::size_t kMaxQuoteLength = 24;

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

// Length of the UTF-8 sequence at the beginning, 0 if it is none.
std::size_t sequence_length(std::string_view text) {
    const auto lead = static_cast<unsigned char>(text[0]);
    const std::size_t length = lead < 0x80 ? 1 : lead >= 0xC2 && lead < 0xE0 ? 2 : lead >= 0xE0 && lead < 0xF0 ? 3 : 4;
    if (lead >= 0x80 && (lead < 0xC2 || lead > 0xF4 || length > text.size())) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80) return 0;
    if (length == 3) {  // overlong forms and surrogates
        const auto second = static_cast<unsigned char>(text[1]);
        if ((lead == 0xE0 && second < 0xA0) || (lead == 0xED && second > 0x9F)) return 0;
    }
    if (length == 4) {
        const auto second = static_cast<unsigned char>(text[1]);
        if ((lead == 0xF0 && second < 0x90) || (lead == 0xF4 && second > 0x8F)) return 0;
    }
    return length;
}

}  // namespace

Error syntax_error(int position, const std::string& what) {
    return {ErrorKind::invalid_argument, "", "character " + std::to_string(position) + ": " + what};
}

std::string quoted(std::string_view piece) {
    std::string result = "\"";
    for (std::size_t i = 0; i < piece.size();) {
        if (i >= kMaxQuoteLength) {
            result += "...";
            break;
        }
        const std::size_t length = sequence_length(piece.substr(i));
        const auto byte = static_cast<unsigned char>(piece[i]);
        if (length == 0 || byte < 0x20 || byte == 0x7F) {
            char spelt[8];
            std::snprintf(spelt, sizeof spelt, "\\x%02X", byte);
            result += spelt;
            ++i;
        } else {
            result += piece.substr(i, length);
            i += length;
        }
    }
    return result + "\"";
}

bool is_identifier(std::string_view name) {
    if (name.empty() || !is_letter(name[0])) return false;
    for (const char c : name)
        if (!is_letter(c) && !is_digit(c)) return false;
    return true;
}

Token TokenReader::taken(TokenKind kind, std::size_t length) {
    const Token token{.kind = kind, .text = text_.substr(at_, length), .number = 0, .position = position_};
    at_ += length;
    position_ += static_cast<int>(length);
    return token;
}

Expected<Token> TokenReader::number() {
    const std::string_view rest = text_.substr(at_);
    double value = 0;
    const auto [end, problem] = std::from_chars(rest.data(), rest.data() + rest.size(), value);
    auto length = static_cast<std::size_t>(end - rest.data());
    if (problem == std::errc::result_out_of_range)
        return syntax_error(position_, quoted(rest.substr(0, length)) + " is out of the range of double precision.");
    // "2x" and "1e" are typing errors, not a number and a name.
    std::size_t word = length;
    while (word < rest.size() && (is_letter(rest[word]) || is_digit(rest[word]) || rest[word] == '.')) ++word;
    if (problem != std::errc{} || word != length)
        return syntax_error(position_, quoted(rest.substr(0, std::max<std::size_t>(word, 1))) +
                                           " is not a number; write an operator such as * between a number and a "
                                           "name.");
    Token token = taken(TokenKind::number, length);
    token.number = value;
    return token;
}

Expected<Token> TokenReader::next() {
    for (; at_ < text_.size() && is_blank(text_[at_]); ++at_) ++position_;
    if (at_ == text_.size()) return Token{.kind = TokenKind::end, .text = {}, .number = 0, .position = position_};
    const std::string_view rest = text_.substr(at_);
    const char c = rest[0];
    if (is_digit(c) || (c == '.' && rest.size() > 1 && is_digit(rest[1]))) return number();
    if (is_letter(c)) {
        std::size_t length = 1;
        while (length < rest.size() && (is_letter(rest[length]) || is_digit(rest[length]))) ++length;
        return taken(TokenKind::name, length);
    }
    for (const std::string_view symbol : {"<=", ">=", "==", "!="})
        if (rest.starts_with(symbol)) return taken(TokenKind::symbol, 2);
    if (rest.starts_with("**")) return syntax_error(position_, "\"**\" is not an operator; write a power with ^.");
    if (std::string_view("+-*/^()<>?:,").find(c) != std::string_view::npos) return taken(TokenKind::symbol, 1);
    if (c == '=') return syntax_error(position_, "\"=\" is not an operator; write equality as ==.");
    const std::size_t length = std::max<std::size_t>(sequence_length(rest), 1);
    return syntax_error(position_, quoted(rest.substr(0, length)) + " cannot be part of an expression.");
}

}  // namespace tunewright
