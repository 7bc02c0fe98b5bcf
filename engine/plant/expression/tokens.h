// Splits an expression into tokens with their positions.
#pragma once

#include <string>
#include <string_view>

#include "engine/expected.h"

namespace tunewright {

enum class TokenKind { number, name, symbol, end };

struct Token {
    TokenKind kind = TokenKind::end;
    std::string_view text;  ///< text of the token; empty at the end
    double number = 0;
    int position = 1;  ///< position of its first character, from 1
};

/// Reads a text token by token. Blanks, tabs and line breaks only separate tokens.
class TokenReader {
public:
    /// `text` must outlive the reader and its tokens.
    explicit TokenReader(std::string_view text) : text_(text) {}

    /// The next token; after the last one always TokenKind::end. Errors: a character that belongs to no token, a number
    /// that is malformed or out of the range of double precision; the message begins with "character n: ".
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

/// In quotation marks and shortened if long; bytes that are not UTF-8 are written as codes, so that any text can be
/// quoted.
std::string quoted(std::string_view piece);

/// True for letters, digits and underscores that do not begin with a digit.
bool is_identifier(std::string_view name);

}  // namespace tunewright
