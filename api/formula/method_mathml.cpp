#include "api/formula/method_mathml.h"

#include <algorithm>

#include "api/formula/elements.h"
#include "api/formula/notation.h"
#include "api/formula/tokens.h"

namespace tunewright::api {
namespace {

using namespace mathml_elements;
using notation::Node;
using notation::Part;

constexpr const char* kTimes = "\u2062";
constexpr const char* kApply = "\u2061";
constexpr const char* kNoBreak = "\u00A0";

bool is_number(std::string_view text) { return text.find_first_not_of("0123456789.") == std::string_view::npos; }

std::string letter(std::string_view name) {
    const std::string_view greek = notation::greek_letter(name);
    return mi(std::string(greek.empty() ? name : greek));
}

/// A symbol's letter and its index: Kp, T1, tau_c. Without an index the second part is empty.
struct Name {
    std::string base, index;
};

Name name_of(std::string_view symbol) {
    if (const std::size_t line = symbol.find('_'); line != std::string_view::npos)
        return {letter(symbol.substr(0, line)), std::string(symbol.substr(line + 1))};
    const std::size_t digits = symbol.find_first_of("0123456789");
    const std::string_view word = symbol.substr(0, digits);
    if (digits != std::string_view::npos) return {letter(word), std::string(symbol.substr(digits))};
    if (word.size() == 1 || !notation::greek_letter(word).empty()) return {letter(word), {}};
    return {letter(word.substr(0, 1)), std::string(word.substr(1))};
}

std::string index_of(const std::string& index) { return is_number(index) ? element("mn", index) : letter(index); }

bool is_differential(std::string_view symbol) { return symbol == "dt" || symbol == "dy"; }

std::string symbol(const std::string& text) {
    if (is_differential(text)) return row(mi(text.substr(0, 1)) + mi(text.substr(1)));
    const Name name = name_of(text);
    return name.index.empty() ? name.base : element("msub", name.base + index_of(name.index));
}

std::string sign(const std::string& text) {
    if (text == "-") return mo("−");
    if (text == "<=") return mo("≤");
    if (text == ">=") return mo("≥");
    if (text == "<") return mo("&lt;");
    if (text == ">") return mo("&gt;");
    return mo(text.c_str());
}

/// Fractions in an exponent or index would be too small to read: they keep the slash there, and its brackets.
enum class ScriptLevel { line, script };

std::string written(const Node& node, ScriptLevel place);

std::string all(const std::vector<Node>& nodes, ScriptLevel place, const std::string& between = {}) {
    std::string out;
    for (const Node& node : nodes) out += (out.empty() ? "" : between) + written(node, place);
    return out;
}

/// The content of brackets that the line of a fraction makes unnecessary.
std::string bare(const Node& node, ScriptLevel place) {
    return written(node.part == Part::brackets ? node.parts.front() : node, place);
}

std::string fraction_of(const Node& node, ScriptLevel place) {
    const Node &above = node.parts[0], &below = node.parts[1];
    if (place == ScriptLevel::script) return row(written(above, place) + mo("/") + written(below, place));
    return fraction(bare(above, place), bare(below, place));
}

bool is_high(const Node& node) { return node.part == Part::fraction || std::ranges::any_of(node.parts, is_high); }

/// Brackets stretch only around a fraction: around powers and indices they would be too large.
std::string in_brackets(const Node& node, ScriptLevel place) {
    const Node& inside = node.parts.front();
    const bool grows = place == ScriptLevel::line && is_high(inside), square = node.text == "[";
    const auto bracket = [&](const char* sign) {
        return grows ? mo(sign) : std::string("<mo stretchy=\"false\">") + sign + "</mo>";
    };
    return row(bracket(square ? "[" : "(") + written(inside, place) + bracket(square ? "]" : ")"));
}

std::string raised(const Node& node) {
    const Node& base = node.parts[0];
    const std::string exponent = row(written(node.parts[1], ScriptLevel::script));
    if (base.part == Part::symbol && !is_differential(base.text)) {
        const Name name = name_of(base.text);
        if (!name.index.empty()) return element("msubsup", name.base + index_of(name.index) + exponent);
    }
    return power(base.part == Part::brackets ? in_brackets(base, ScriptLevel::line) : written(base, ScriptLevel::line),
                 exponent);
}

std::string applied(const Node& node, ScriptLevel place) {
    const Node& to = node.parts.front();
    if (node.text == "sqrt" && to.part == Part::brackets) return element("msqrt", written(to.parts.front(), place));
    const std::string argument = to.part == Part::brackets ? in_brackets(to, place) : written(to, place);
    return row(mi(node.text) + mo(kApply) + argument);
}

std::string big(const Node& node) {
    const std::string sign = mo(node.text == "int" ? "∫" : "∑");
    if (node.parts.empty()) return sign;
    const std::string limits = all(node.parts, ScriptLevel::script);
    return element(node.parts.size() == 1 ? "msub" : "msubsup", sign + limits);
}

std::string written(const Node& node, ScriptLevel place) {
    switch (node.part) {
        case Part::number: return element("mn", node.text);
        case Part::symbol: return symbol(node.text);
        case Part::sign: return sign(node.text);
        case Part::words: return element("mtext", node.text);
        case Part::row: return row(all(node.parts, place));
        case Part::product: return row(all(node.parts, place, mo(kTimes)));
        case Part::fraction: return fraction_of(node, place);
        case Part::power: return raised(node);
        case Part::brackets: {
            const bool held = node.parts.front().part == Part::fraction && place == ScriptLevel::line;
            return held ? written(node.parts.front(), place) : in_brackets(node, place);
        }
        case Part::bars: return row(mo("|") + written(node.parts.front(), place) + mo("|"));
        case Part::apply: return applied(node, place);
        case Part::big: return big(node);
    }
    return {};
}

/// Puts a space between words and formulas, but none before the colon that ends a label.
std::string cell(const notation::Cell& parts) {
    std::string out;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (parts[i].part != Part::words) {
            out += written(parts[i], ScriptLevel::line);
            continue;
        }
        const bool spaced = i > 0 && parts[i].text != ":";
        out += element("mtext", (spaced ? kNoBreak : "") + parts[i].text + (i + 1 < parts.size() ? kNoBreak : ""));
    }
    return element("mtd", out);
}

}  // namespace

Expected<std::string> method_mathml(std::string_view formula) {
    const auto lines = notation::read_formula(formula);
    if (!lines) return lines.error();
    std::string rows;
    for (const notation::Line& line : *lines) {
        std::string cells = cell(line.label);
        for (const notation::Cell& one : line.cells) cells += cell(one);
        rows += element("mtr", cells);
    }
    return math(element("mtable", rows));
}

}  // namespace tunewright::api
