#include "tests/api/formula/read_mathml.h"

#include <algorithm>
#include <initializer_list>
#include <stdexcept>
#include <utility>

namespace tunewright::api {
namespace {

void replace_all(std::string& text, std::string_view from, std::string_view to) {
    for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
        text.replace(at, from.size(), to);
}

Markup read_inside(std::string_view text, std::size_t& at, std::string tag) {
    Markup element{std::move(tag), "", {}};
    while (at < text.size()) {
        if (text[at] != '<') {
            const std::size_t end = std::min(text.find('<', at), text.size());
            std::string words(text.substr(at, end - at));
            replace_all(words, "&lt;", "<");
            replace_all(words, "&gt;", ">");
            if (words.find('&') != std::string::npos) throw std::runtime_error("an entity in " + words);
            element.inside.push_back({"", words, {}});
            at = end;
            continue;
        }
        const std::size_t end = text.find('>', at);
        if (end == std::string_view::npos) throw std::runtime_error("a tag without end");
        const std::string_view inner = text.substr(at + 1, end - at - 1);
        at = end + 1;
        if (inner.starts_with("/")) {
            if (inner.substr(1) != element.tag) throw std::runtime_error("the end of another element");
            return element;
        }
        element.inside.push_back(read_inside(text, at, std::string(inner.substr(0, inner.find(' ')))));
    }
    if (!element.tag.empty()) throw std::runtime_error("no end of " + element.tag);
    return element;
}

std::string part(const Markup& markup, std::size_t i) { return "(" + typed_out(markup.inside.at(i)) + ")"; }

std::string index(const Markup& markup) {
    return typed_out(markup.inside.at(0)) + "_" + typed_out(markup.inside.at(1));
}

}  // namespace

Markup read_markup(std::string_view text) {
    std::size_t at = 0;
    return read_inside(text, at, "");
}

std::string leaves(const Markup& markup) {
    std::string out = markup.text;
    for (const Markup& one : markup.inside) out += leaves(one);
    return out;
}

std::string on_a_keyboard(std::string text) {
    for (const auto& [sign, name] : std::initializer_list<std::pair<const char*, const char*>>{{"α", "alpha"},
                                                                                               {"β", "beta"},
                                                                                               {"δ", "delta"},
                                                                                               {"κ", "kappa"},
                                                                                               {"λ", "lambda"},
                                                                                               {"ω", "omega"},
                                                                                               {"φ", "phi"},
                                                                                               {"π", "pi"},
                                                                                               {"τ", "tau"},
                                                                                               {"−", "-"},
                                                                                               {"≤", "<="},
                                                                                               {"≥", ">="},
                                                                                               {"∫", "int"},
                                                                                               {"∑", "sum"},
                                                                                               {"\u2062", ""},
                                                                                               {"\u2061", ""},
                                                                                               {"\u00A0", " "}})
        replace_all(text, sign, name);
    return text;
}

std::string typed_out(const Markup& markup) {
    if (markup.tag == "mfrac") return "(" + part(markup, 0) + "/" + part(markup, 1) + ")";
    if (markup.tag == "msup") return part(markup, 0) + "^" + part(markup, 1);
    if (markup.tag == "msub") return index(markup);
    if (markup.tag == "msubsup") return index(markup) + "^" + part(markup, 2);
    if (markup.tag == "msqrt") return "sqrt(" + typed_out(markup.inside.at(0)) + ")";
    if (markup.tag == "mo" && leaves(markup) == "\u2062") return "*";
    if (markup.tag == "mo" && leaves(markup) == "[") return "(";
    if (markup.tag == "mo" && leaves(markup) == "]") return ")";
    std::string out = on_a_keyboard(markup.text);
    for (const Markup& one : markup.inside) out += typed_out(one);
    return out;
}

}  // namespace tunewright::api
