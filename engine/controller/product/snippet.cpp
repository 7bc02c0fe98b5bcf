#include "engine/controller/product/snippet.h"

#include <cmath>
#include <optional>

#include "engine/controller/product/typed.h"
#include "engine/number_text.h"

namespace tunewright::product {
namespace {

/// The parts of `text` before and after the first `separator`; the second is empty if there is none.
struct Parts {
    std::string_view before;
    std::optional<std::string_view> after;
};
Parts split(std::string_view text, char separator) {
    const std::size_t at = text.find(separator);
    if (at == text.npos) return {text, std::nullopt};
    return {text.substr(0, at), text.substr(at + 1)};
}

class Filler {
public:
    Filler(const Product& product, const Settings& typed, const Context& context) : product_(product), typed_(typed) {
        period_s_ = context.sample_time_s ? context.sample_time_s : default_sample_time_s(product);
    }

    /// Empty if a value is missing.
    std::optional<std::string> line(std::string_view text) const {
        std::string out;
        while (true) {
            const auto [before, rest] = split(text, '{');
            out += before;
            if (!rest) return out;
            if (rest->starts_with('{')) {
                out += '{';
                text = rest->substr(1);
                continue;
            }
            const auto [placeholder, after] = split(*rest, '}');
            const auto filled = value(placeholder);
            if (!filled) return std::nullopt;
            out += *filled;
            text = after.value_or("");
        }
    }

private:
    std::optional<std::string> value(std::string_view placeholder) const {
        if (const auto [name, condition] = split(placeholder, '='); condition) {
            const auto [wanted, words] = split(*condition, ':');
            const auto [yes, no] = split(words.value_or(""), '/');
            return std::string(setting(name) == wanted ? yes : no.value_or(""));
        }
        const auto [name, other] = split(placeholder, '|');
        auto found = setting(name);
        if (!found && other) found = std::string(*other);
        return found;
    }

    std::optional<std::string> setting(std::string_view name) const {
        if (const Value* given = setting_named(typed_, name)) return typed_text(product_, {std::string(name), *given});
        if (!period_s_) return std::nullopt;
        if (name == "sample_time_s") return text(*period_s_, 6);
        if (name == "sample_time_ms") return whole(1e3 * *period_s_);
        if (name == "sample_time_us") return whole(1e6 * *period_s_);
        return std::nullopt;
    }

    /// Empty if the program could not hold it.
    static std::optional<std::string> whole(double period) {
        constexpr double kMaxPeriod = 2147483647;  // 32 bits with a sign
        if (!(period >= 0.5 && period < kMaxPeriod)) return std::nullopt;
        return std::to_string(std::lround(period));
    }

    const Product& product_;
    const Settings& typed_;
    std::optional<double> period_s_;
};

}  // namespace

std::vector<FilledSnippet> filled_snippets(const Product& product, const Settings& typed, const Context& context) {
    const Filler filler(product, typed, context);
    std::vector<FilledSnippet> all;
    for (const Snippet& snippet : product.snippets) {
        FilledSnippet filled{snippet.name, ""};
        for (std::optional<std::string_view> rest = snippet.text; rest;) {
            const auto [line, after] = split(*rest, '\n');
            if (const auto text = filler.line(line)) filled.text += (filled.text.empty() ? "" : "\n") + *text;
            rest = after;
        }
        if (!filled.text.empty()) all.push_back(std::move(filled));
    }
    return all;
}

}  // namespace tunewright::product
