#include "api/formula/notation.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <span>

#include "api/formula/tokens.h"

namespace tunewright::api::notation {
namespace {

using Tokens = std::span<const FormulaToken>;

std::string closing_of(const std::string& opening) { return opening == "(" ? ")" : "]"; }

/// The parts as a row, or the only part itself.
Node together(Part part, std::vector<Node> parts) {
    if (parts.size() == 1) return std::move(parts.front());
    return {part, "", std::move(parts)};
}

/// Recursive descent over the tokens of one formula. After the first error every function returns at once.
class FormulaReader {
public:
    FormulaReader(Tokens tokens, std::size_t end) : tokens_(tokens), end_(end) {}

    Expected<Node> whole() {
        Node found = list(true);
        if (!error_ && at_ < tokens_.size()) fail("is out of place here");
        if (error_) return *error_;
        return found;
    }

private:
    const FormulaToken* here() const { return !error_ && at_ < tokens_.size() ? &tokens_[at_] : nullptr; }
    bool at(std::string_view sign) const { return here() && here()->is(sign); }
    bool skip(std::string_view sign) {
        const bool found = at(sign);
        if (found) ++at_;
        return found;
    }

    Node fail(const std::string& what) {
        if (error_) return {};
        const bool over = at_ >= tokens_.size();
        const std::string place = std::to_string(over ? end_ : tokens_[at_].position);
        error_ = Error{ErrorKind::invalid_argument, "",
                       "character " + place + ": " + (over ? "the formula" : "\"" + tokens_[at_].text + "\"") + " " +
                           (over ? "ends too early" : what) + "."};
        return {};
    }

    /// Reads sums with relations and commas between them.
    Node list(bool may_end_with_comma) {
        std::vector<Node> parts = sum();
        while (here() && (here()->is(",") || here()->is_relation())) {
            const bool comma = here()->is(",");
            parts.push_back({Part::sign, here()->text});
            ++at_;
            if (comma && may_end_with_comma && at_ == tokens_.size()) break;
            std::ranges::move(sum(), std::back_inserter(parts));
        }
        return together(Part::row, std::move(parts));
    }

    std::vector<Node> sum() {
        std::vector<Node> parts;
        do {
            if (at("+") || at("-")) {
                parts.push_back({Part::sign, here()->text});
                ++at_;
            }
            parts.push_back(term());
        } while (at("+") || at("-"));
        return parts;
    }

    /// Reads factors; each slash divides the product before it by the next factor.
    Node term() {
        std::vector<Node> factors{factor()};
        while (here() && !error_) {
            if (skip("/")) {
                Node above = together(Part::product, std::move(factors));
                factors = {{Part::fraction, "", {std::move(above), factor()}}};
            } else if (begins_factor()) {
                factors.push_back(factor());
            } else {
                break;
            }
        }
        return together(Part::product, std::move(factors));
    }

    bool begins_factor() const {
        if (at("|")) return !inside_bars_;
        return at("(") || at("[") || here()->kind != NotationToken::sign;
    }

    Node factor() {
        Node base = atom();
        if (at("!")) {
            ++at_;
            base = {Part::row, "", {std::move(base), {Part::sign, "!"}}};
        }
        if (base.part == Part::big || !skip("^")) return base;
        return {Part::power, "", {std::move(base), exponent()}};
    }

    /// Brackets that only group an exponent are not shown above the line.
    Node exponent() {
        const bool negative = skip("-");
        Node value = atom();
        if (value.part == Part::brackets) value = std::move(value.parts.front());
        if (negative) return {Part::row, "", {{Part::sign, "-"}, std::move(value)}};
        return value;
    }

    Node atom() {
        const FormulaToken* token = here();
        if (!token) return fail("");
        if (at("(") || at("[") || at("|")) return enclosed();
        switch (token->kind) {
            case NotationToken::number: ++at_; return {Part::number, token->text};
            case NotationToken::symbol: ++at_; return {Part::symbol, token->text};
            case NotationToken::function: ++at_; return {Part::apply, token->text, {enclosed()}};
            case NotationToken::big: return big();
            default: return fail("stands where a number, a symbol or a bracket belongs");
        }
    }

    Node enclosed() {
        if (skip("|")) {
            inside_bars_ = true;
            Node inside = list(false);
            inside_bars_ = false;
            if (!skip("|")) return fail("stands where | belongs");
            return {Part::bars, "", {std::move(inside)}};
        }
        const std::string opening = here()->text;
        ++at_;
        Node inside = list(false);
        if (!skip(closing_of(opening))) return fail("stands where " + closing_of(opening) + " belongs");
        return {Part::brackets, opening, {std::move(inside)}};
    }

    Node big() {
        const std::string& name = here()->text;
        ++at_;
        const std::size_t index = name.find('_');
        Node made{Part::big, name.substr(0, index)};
        if (index == std::string::npos) return made;
        const std::string lower = name.substr(index + 1);
        made.parts.push_back(
            {lower.find_first_not_of("0123456789") == std::string::npos ? Part::number : Part::symbol, lower});
        if (skip("^")) made.parts.push_back(exponent());
        return made;
    }

    Tokens tokens_;
    std::size_t end_;
    std::size_t at_ = 0;
    bool inside_bars_ = false;
    std::optional<Error> error_;
};

/// Reads formulas and the words between them. A comma after a word is part of the words.
Expected<Cell> read_cell(Tokens tokens, std::size_t end) {
    Cell cell;
    while (!tokens.empty()) {
        const bool words = tokens.front().kind == NotationToken::word;
        std::size_t length = 0;
        if (words) {
            std::string text;
            for (; length < tokens.size() && (tokens[length].kind == NotationToken::word || tokens[length].is(","));
                 ++length)
                text += (text.empty() || tokens[length].is(",") ? "" : " ") + tokens[length].text;
            cell.push_back({Part::words, text});
        } else {
            while (length < tokens.size() && tokens[length].kind != NotationToken::word) ++length;
            const std::size_t over = length < tokens.size() ? tokens[length].position : end;
            auto formula = FormulaReader(tokens.first(length), over).whole();
            if (!formula) return formula.error();
            cell.push_back(std::move(*formula));
        }
        tokens = tokens.subspan(length);
    }
    return cell;
}

/// True if it has a relation with no words before it.
bool is_equation(Tokens piece) {
    for (const FormulaToken& token : piece) {
        if (token.kind == NotationToken::word) return false;
        if (token.is_relation()) return true;
    }
    return false;
}

/// The pieces between commas outside brackets, each with the comma that ends it.
std::vector<Tokens> pieces_of(Tokens line) {
    std::vector<Tokens> pieces;
    int depth = 0;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (line[i].is("(") || line[i].is("[")) ++depth;
        if (line[i].is(")") || line[i].is("]")) --depth;
        if (depth > 0 || !line[i].is(",")) continue;
        pieces.push_back(line.subspan(begin, i + 1 - begin));
        begin = i + 1;
    }
    pieces.push_back(line.subspan(begin));
    return pieces;
}

/// Adjacent words become one text.
void add(Cell& cell, Node node) {
    if (node.part == Part::words && !cell.empty() && cell.back().part == Part::words)
        cell.back().text += " " + node.text;
    else
        cell.push_back(std::move(node));
}

void add_colon(Cell& label) {
    if (!label.empty() && label.back().part == Part::words)
        label.back().text += ":";
    else
        label.push_back({Part::words, ":"});
}

Expected<Line> read_line(Tokens tokens, std::size_t end) {
    Line line;
    std::size_t length = tokens.size();
    while (length > 0 && tokens[length - 1].kind != NotationToken::label_end) --length;
    if (length-- > 0) {
        // A label within a label: "Regulation, 0 %: P:".
        Tokens rest = tokens.first(length);
        for (bool more = true; more;) {
            const auto colon = std::ranges::find(rest, NotationToken::label_end, &FormulaToken::kind);
            const auto size = static_cast<std::size_t>(colon - rest.begin());
            auto part = read_cell(rest.first(size), tokens[length].position);
            if (!part) return part.error();
            for (Node& node : *part) add(line.label, std::move(node));
            add_colon(line.label);
            more = size < rest.size();
            rest = rest.subspan(std::min(size + 1, rest.size()));
        }
        tokens = tokens.subspan(length + 1);
    }
    const std::vector<Tokens> pieces = pieces_of(tokens);
    for (std::size_t i = 0; i < pieces.size();) {
        std::size_t count = pieces[i].size(), next = i + 1;
        while (next < pieces.size() && !is_equation(pieces[next - 1]) && !is_equation(pieces[next]))
            count += pieces[next++].size();
        auto cell = read_cell(Tokens(pieces[i].data(), count), end);
        if (!cell) return cell.error();
        line.cells.push_back(std::move(*cell));
        i = next;
    }
    return line;
}

}  // namespace

Expected<std::vector<Line>> read_formula(std::string_view text) {
    const auto tokens = formula_tokens(text);
    if (!tokens) return tokens.error();
    std::vector<Line> lines;
    for (Tokens rest(*tokens); !rest.empty();) {
        const auto end = std::ranges::find(rest, NotationToken::line_end, &FormulaToken::kind);
        const auto length = static_cast<std::size_t>(end - rest.begin());
        auto line = read_line(rest.first(length), length < rest.size() ? end->position : text.size() + 1);
        if (!line) return line.error();
        lines.push_back(std::move(*line));
        rest = rest.subspan(std::min(length + 1, rest.size()));
    }
    return lines;
}

}  // namespace tunewright::api::notation
