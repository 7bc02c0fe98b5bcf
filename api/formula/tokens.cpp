#include "api/formula/tokens.h"

#include <algorithm>
#include <cctype>
#include <utility>

namespace tunewright::api::notation {
namespace {

constexpr std::pair<std::string_view, std::string_view> kGreek[] = {{"alpha", "α"}, {"beta", "β"},   {"delta", "δ"},
                                                                    {"kappa", "κ"}, {"lambda", "λ"}, {"omega", "ω"},
                                                                    {"phi", "φ"},   {"pi", "π"},     {"tau", "τ"}};

/// Symbols of more than one letter; the second and following ones are an index.
constexpr std::string_view kPairs[] = {"Kp", "Ki", "Kd", "Ti", "Td", "Tf", "Ku", "Pu",
                                       "Ms", "Mt", "Am", "wy", "wu", "dt", "dy"};

bool is_letter_of_name(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; }
bool is_digit_of_name(char c) { return c >= '0' && c <= '9'; }
bool is_part_of_name(char c) { return is_letter_of_name(c) || is_digit_of_name(c) || c == '_'; }

bool is_symbol(std::string_view name) {
    std::string_view base = name.substr(0, name.find('_'));
    while (base.size() > 1 && is_digit_of_name(base.back())) base.remove_suffix(1);
    if (base.size() == 1) return base != "P";  // the controller P, as in PI and PID
    return !greek_letter(base).empty() || std::ranges::find(kPairs, base) != std::end(kPairs);
}

/// Reads from the left; each function consumes one token.
class Lexer {
public:
    explicit Lexer(std::string_view text) : text_(text) {}

    Expected<std::vector<FormulaToken>> all() {
        std::vector<FormulaToken> tokens;
        for (skip_blanks(); at_ < text_.size(); skip_blanks()) {
            FormulaToken token = next();
            if (token.text.empty())
                return Error{ErrorKind::invalid_argument, "",
                             "character " + std::to_string(at_ + 1) + " has no meaning in a formula."};
            at_ += token.text.size();
            // "a" is the article if a word follows it.
            if (token.kind == NotationToken::word && !tokens.empty() && tokens.back().text == "a")
                tokens.back().kind = NotationToken::word;
            tokens.push_back(std::move(token));
        }
        return tokens;
    }

private:
    void skip_blanks() {
        while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    }

    FormulaToken token(NotationToken kind, std::size_t length) const {
        return {kind, std::string(text_.substr(at_, length)), at_ + 1};
    }

    FormulaToken next() const {
        const char c = text_[at_];
        if (is_digit_of_name(c)) return token(NotationToken::number, number_length());
        if (is_letter_of_name(c)) return name();
        const std::string_view rest = text_.substr(at_);
        if (rest.starts_with("<=") || rest.starts_with(">=")) return token(NotationToken::sign, 2);
        if (c == ';' || c == '.') return token(NotationToken::line_end, 1);
        if (c == ':') return token(NotationToken::label_end, 1);
        if (c == '%') return token(NotationToken::word, 1);
        return token(NotationToken::sign, std::string_view("+-/^()[]|=<>!,").find(c) == std::string_view::npos ? 0 : 1);
    }

    std::size_t number_length() const {
        std::size_t end = at_;
        while (end < text_.size() && is_digit_of_name(text_[end])) ++end;
        if (end + 1 < text_.size() && text_[end] == '.' && is_digit_of_name(text_[end + 1]))
            for (++end; end < text_.size() && is_digit_of_name(text_[end]);) ++end;
        return end - at_;
    }

    FormulaToken name() const {
        std::size_t end = at_;
        while (end < text_.size() && is_part_of_name(text_[end])) ++end;
        const std::string_view found = text_.substr(at_, end - at_);
        const std::string_view base = found.substr(0, found.find('_'));
        if (base == "int" || base == "sum") return token(NotationToken::big, end - at_);
        for (const std::string_view function : {"min", "max", "exp", "sqrt"})
            if (found == function && opens(end)) return token(NotationToken::function, end - at_);
        if (is_symbol(found)) return token(NotationToken::symbol, end - at_);
        // Words may contain these signs: docs/methods.md, half-rule.
        while (end + 1 < text_.size() && std::string_view("-./").find(text_[end]) != std::string_view::npos &&
               is_letter_of_name(text_[end + 1]))
            for (++end; end < text_.size() && is_part_of_name(text_[end]);) ++end;
        return token(NotationToken::word, end - at_);
    }

    bool opens(std::size_t end) const {
        const std::size_t next = text_.find_first_not_of(' ', end);
        return next != std::string_view::npos && (text_[next] == '(' || text_[next] == '|');
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

}  // namespace

std::string_view greek_letter(std::string_view name) {
    const auto* const found = std::ranges::find(kGreek, name, &std::pair<std::string_view, std::string_view>::first);
    return found == std::end(kGreek) ? std::string_view() : found->second;
}

Expected<std::vector<FormulaToken>> formula_tokens(std::string_view text) { return Lexer(text).all(); }

}  // namespace tunewright::api::notation
