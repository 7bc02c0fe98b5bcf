#include "engine/plant/typed/words.h"

#include <algorithm>
#include <charconv>
#include <utility>

#include "engine/plant/expression/tokens.h"

namespace tunewright::typed {
namespace {

using Kind = Word::Kind;

bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

/// The meaning of a character that is not ASCII.
struct Spelling {
    const char* written;
    const char* meant;
};

constexpr Spelling kSigns[] = {{"−", "-"},      {"–", "-"}, {"·", "*"}, {"⋅", "*"},  {"∙", "*"},      {"×", "*"},
                               {"÷", "/"},      {"∕", "/"}, {"⁄", "/"}, {"±", "+-"}, {"\u00A0", " "}, {"\u2009", " "},
                               {"\u202F", " "}, {"’", "'"}, {"‘", "'"}, {"“", "'"},  {"”", "'"}};
constexpr Spelling kLetters[] = {{"τ", "tau"}, {"θ", "theta"}, {"ζ", "zeta"}, {"ξ", "zeta"}, {"ω", "w"}, {"µ", "u"},
                                 {"μ", "u"},   {"₀", "0"},     {"₁", "1"},    {"₂", "2"},    {"ₙ", "n"}, {"₃", "3"}};
constexpr Spelling kSuperscripts[] = {{"⁰", "0"}, {"¹", "1"}, {"²", "2"}, {"³", "3"}, {"⁴", "4"},
                                      {"⁵", "5"}, {"⁶", "6"}, {"⁷", "7"}, {"⁸", "8"}, {"⁹", "9"},
                                      {"⁺", "+"}, {"⁻", "-"}, {"ˢ", "s"}};

/// The spelling with which `rest` begins; null: none.
template <std::size_t n>
const Spelling* spelling_at(const Spelling (&known)[n], std::string_view rest) {
    for (const Spelling& spelling : known)
        if (rest.starts_with(spelling.written)) return &spelling;
    return nullptr;
}

std::size_t length_of_character(std::string_view rest) {
    const auto lead = static_cast<unsigned char>(rest[0]);
    const std::size_t length = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
    return std::min(length, rest.size());
}

/// Splits a text into words; positions count characters.
class WordCutter {
public:
    explicit WordCutter(std::string_view text) : text_(text) {}

    Expected<std::vector<Word>> cut() {
        while (!fault_ && at_ < text_.size()) next();
        if (fault_) return *fault_;
        add(Kind::end, "", position_);
        return std::move(words_);
    }

private:
    std::string_view rest() const { return text_.substr(at_); }

    void take(std::size_t bytes) {
        for (std::size_t i = 0; i < bytes; ++i)
            position_ += (static_cast<unsigned char>(text_[at_ + i]) & 0xC0) != 0x80;
        at_ += bytes;
    }

    void add(Kind kind, std::string text, int position, double number = 0) {
        words_.push_back({kind, std::move(text), number, position, blank_, line_});
        blank_ = line_ = false;
    }

    void add_symbol(std::string text, std::size_t bytes) {
        add(Kind::symbol, std::move(text), position_);
        take(bytes);
    }

    void next() {
        const char c = rest()[0];
        if (c == ' ' || c == '\t' || c == '\n' || c == '\r') {
            blank_ = true;
            line_ |= c == '\n' || c == '\r';
            return take(1);
        }
        if (begins_comment()) return take(std::min(rest().find_first_of("\r\n"), rest().size()));
        if (rest().starts_with("...")) return take(3);  // MATLAB: the statement continues in the next line
        if (is_digit(c) || (c == '.' && rest().size() > 1 && is_digit(rest()[1]))) return number();
        if (is_letter(c) || c == '\\' || spelling_at(kLetters, rest())) return name();
        if (spelling_at(kSuperscripts, rest())) return superscripts();
        if (c == '\'' && !blank_ && !words_.empty() && Cursor::is(words_.back(), "]")) return add_symbol("'", 1);
        if (c == '\'' || c == '"') return quoted_word();
        if (rest().starts_with("**")) return add_symbol("^", 2);
        if (rest().starts_with("+-") && rest().size() > 2 && (is_digit(rest()[2]) || rest()[2] == '.'))
            return add_symbol("+-", 2);
        if (const Spelling* sign = spelling_at(kSigns, rest())) return foreign_sign(*sign);
        if (std::string_view("+-*/^()[]{},;=:").find(c) != std::string_view::npos)
            return add_symbol(std::string(1, c), 1);
        fault_ = fault_at(position_, quoted(rest().substr(0, length_of_character(rest()))) +
                                         " has no meaning in a plant; write for example 2 e^(-3s)/(10s+1).");
    }

    /// A sign of percent elsewhere may be a unit: it is refused.
    bool begins_comment() const {
        if (rest()[0] == '#') return true;
        const bool at_statement = words_.empty() || line_ || Cursor::is(words_.back(), ";");
        return at_statement && (rest()[0] == '%' || rest().starts_with("//"));
    }

    void foreign_sign(const Spelling& sign) {
        const std::size_t length = std::string_view(sign.written).size();
        if (sign.meant[0] == ' ') {
            blank_ = true;
            return take(length);
        }
        if (sign.meant[0] == '\'') return quoted_word();
        add_symbol(sign.meant, length);
    }

    void number() {
        double value = 0;
        const auto [end, problem] = std::from_chars(rest().data(), rest().data() + rest().size(), value);
        const auto length = static_cast<std::size_t>(end - rest().data());
        if (problem != std::errc{}) {
            fault_ = fault_at(position_, quoted(rest().substr(0, length)) + " is out of the number range.");
            return;
        }
        add(Kind::number, std::string(rest().substr(0, length)), position_, value);
        take(length);
    }

    // A dot joins names, as in control.tf; the last one is the word.
    void name() {
        const int position = position_;
        std::string name, prefix;
        while (at_ < text_.size()) {
            const char c = rest()[0];
            const Spelling* letter = spelling_at(kLetters, rest());
            const bool joins = c == '.' && !name.empty() && rest().size() > 1 && is_letter(rest()[1]);
            if (joins) {
                prefix = std::exchange(name, "");
            } else if (letter) {
                name += letter->meant;
            } else if (is_letter(c) || c == '\\' || (is_digit(c) && !name.empty())) {
                name += c;
            } else {
                break;
            }
            take(letter ? std::string_view(letter->written).size() : 1);
        }
        if (name == "\\cdot" || name == "\\times") return add(Kind::symbol, "*", position);
        add(Kind::name, std::move(name), position);
        words_.back().prefix = std::move(prefix);
    }

    void superscripts() {
        const int position = position_;
        std::string inside;
        while (at_ < text_.size()) {
            const Spelling* sign = spelling_at(kSuperscripts, rest());
            if (!sign) break;
            inside += sign->meant;
            take(std::string_view(sign->written).size());
        }
        auto words = WordCutter(inside).cut();
        if (!words) {
            fault_ = fault_at(position, "this power is not readable; write it with ^, as in s^2.");
            return;
        }
        add(Kind::symbol, "^", position);
        add(Kind::symbol, "(", position);
        for (Word& word : *words)
            if (word.kind != Kind::end) add(word.kind, std::move(word.text), position, word.number);
        add(Kind::symbol, ")", position);
    }

    void quoted_word() {
        const int position = position_;
        const auto quote_length = [&] {
            const Spelling* sign = spelling_at(kSigns, rest());
            return sign && sign->meant[0] == '\'' ? std::string_view(sign->written).size() : std::size_t{1};
        };
        const auto at_quote = [&] {
            const Spelling* sign = spelling_at(kSigns, rest());
            return rest()[0] == '\'' || rest()[0] == '"' || (sign && sign->meant[0] == '\'');
        };
        take(quote_length());
        const std::size_t begin = at_;
        while (at_ < text_.size() && !at_quote()) take(1);
        if (at_ == text_.size()) {
            fault_ = fault_at(position, "the quotation mark here is not closed; close it.");
            return;
        }
        add(Kind::quoted, std::string(text_.substr(begin, at_ - begin)), position);
        take(quote_length());
    }

    std::string_view text_;
    std::size_t at_ = 0;
    int position_ = 1;
    bool blank_ = false, line_ = false;
    std::vector<Word> words_;
    std::optional<Error> fault_;
};

}  // namespace

Error fault_at(int position, const std::string& what) {
    return {ErrorKind::invalid_argument, "", "position " + std::to_string(position) + ": " + what};
}

Expected<std::vector<Word>> words_of(std::string_view text) {
    if (text.size() > kMaxLength)
        return Error{ErrorKind::invalid_argument, "",
                     "the text has " + std::to_string(text.size()) + " characters; at most " +
                         std::to_string(kMaxLength) + " are read."};
    return WordCutter(text).cut();
}

const Word& Cursor::peek(std::size_t ahead) const {
    return fault_ ? words_.back() : words_[std::min(at_ + ahead, words_.size() - 1)];
}

bool Cursor::skip(std::string_view symbol) {
    if (!at(symbol)) return false;
    advance();
    return true;
}

void Cursor::fail(int position, const std::string& what) {
    if (!fault_) fault_ = fault_at(position, what);
}

void Cursor::unexpected(const std::string& wanted) {
    const Word& word = now();
    if (word.kind != Word::Kind::end)
        return fail(word.position, quoted(word.text) + " stands where " + wanted + " belongs.");
    if (opened_.empty()) return fail(word.position, "the text ends where " + wanted + " belongs.");
    const int position = opened_.back();
    if (!fault_)
        fault_ = Error{ErrorKind::invalid_argument, "",
                       "a bracket is not closed; it opens at position " + std::to_string(position) + "; close it."};
}

bool opens(const Word& word) { return Cursor::is(word, "(") || Cursor::is(word, "[") || Cursor::is(word, "{"); }

bool closes(const Word& word) { return Cursor::is(word, ")") || Cursor::is(word, "]") || Cursor::is(word, "}"); }

bool is_name(const Word& word, std::string_view name) { return word.kind == Kind::name && word.text == name; }

const char* closing(const Word& bracket) { return bracket.text == "(" ? ")" : bracket.text == "[" ? "]" : "}"; }

std::string lower(std::string_view name) {
    std::string out(name);
    for (char& c : out) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return out;
}

}  // namespace tunewright::typed
