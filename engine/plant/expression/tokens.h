// The words of an expression, each with its place.
#pragma once

#include <string>
#include <string_view>

#include "engine/expected.h"

namespace tunewright {

enum class TokenKind { number, name, symbol, end };

struct Token {
    TokenKind kind = TokenKind::end;
    std::string_view text;  ///< of the expression; empty at its end
    double number = 0;
    int position = 1;  ///< of its first character, from 1
};

/// Reads a text token by token. Blanks, tabs and line breaks separate tokens and mean nothing else.
class TokenReader {
public:
    /// `text` must outlive the reader and its tokens.
    explicit TokenReader(std::string_view text) : text_(text) {}

    /// After the last one always TokenKind::end. Errors: a character that belongs to no token, a number that is
    /// malformed or beyond double precision; the message begins with "character n: ".
    Expected<Token> next();

private:
    Expected<Token> number();
    Token taken(TokenKind kind, std::size_t length);

    std::string_view text_;
    std::size_t at_ = 0;
    int position_ = 1;
};

/// An error of an expression's text: "character 17: <what>".
Error syntax_error(int position, const std::string& what);

/// In quotation marks and shortened where long; bytes that are no UTF-8 are spelt out, so that any text can be quoted.
std::string quoted(std::string_view piece);

/// Letters, digits and underscores, not beginning with a digit.
bool is_identifier(std::string_view name);

}  // namespace tunewright
