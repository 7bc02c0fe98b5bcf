// The words of a typed plant's text with their positions; different spellings of the same word become one.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/expected.h"

namespace tunewright::typed {

constexpr int kMaxLength = 2000;  ///< bytes of a text

struct Word {
    enum class Kind { number, name, quoted, symbol, end };
    Kind kind = Kind::end;
    std::string text;          ///< one spelling: - * / ^ +- ( ) [ ] , ; = : for symbols, Greek letters as words
    double number = 0;         ///< value of a number
    int position = 1;          ///< position of its first character, from 1
    bool after_blank = false;  ///< white space precedes it
    bool after_line = false;   ///< a line break precedes it
    std::string prefix = {};   ///< of a name with dots, the name before the last dot: y of a.y has a
};

/// The words of the text; the last is of kind `end`. Minus signs and dots of every alphabet, ** and superscripts are
/// converted: s² becomes s ^ ( 2 ). Comments of programs are left out: # up to the end of the line, % and // where a
/// statement could begin. A ' after ] is the symbol of a transpose. Errors: too long, not valid UTF-8, an unknown
/// character, or a number out of range.
Expected<std::vector<Word>> words_of(std::string_view text);

/// invalid_argument with "position 7: <what>".
Error fault_at(int position, const std::string& what);

/// The position of a reader of words, and the first error. After an error nothing more is read: every further word is
/// the end.
class Cursor {
public:
    explicit Cursor(std::vector<Word> words) : words_(std::move(words)) {}

    const Word& now() const { return peek(0); }
    const Word& peek(std::size_t ahead) const;
    void advance() { at_ += at_ + 1 < words_.size() ? 1 : 0; }

    bool at(std::string_view symbol) const { return is(now(), symbol); }
    static bool is(const Word& word, std::string_view symbol) {
        return word.kind == Word::Kind::symbol && word.text == symbol;
    }
    bool at_end() const { return now().kind == Word::Kind::end; }
    bool at_number() const { return now().kind == Word::Kind::number; }
    bool at_name() const { return now().kind == Word::Kind::name; }
    bool skip(std::string_view symbol);
    /// Records an opened bracket, so that an unexpected end can name it.
    void open(const Word& bracket) { opened_.push_back(bracket.position); }
    void close() { opened_.pop_back(); }

    void fail(int position, const std::string& what);
    /// Reports the current word where `wanted` is expected; at an end inside a bracket it reports the bracket.
    void unexpected(const std::string& wanted);
    bool failed() const { return fault_.has_value(); }
    const Error& fault() const { return *fault_; }

private:
    std::vector<Word> words_;
    std::size_t at_ = 0;
    std::vector<int> opened_;
    std::optional<Error> fault_;
};

/// True for the name `name`.
bool is_name(const Word& word, std::string_view name);

/// True for an opening bracket of any kind, and the bracket that closes it.
bool opens(const Word& word);
const char* closing(const Word& bracket);
bool closes(const Word& word);

/// The word in lower case, because "InputDelay" and "FOPDT" have several spellings.
std::string lower(std::string_view name);

}  // namespace tunewright::typed
