// A method's struct of options with the description of each member: from it follow decoding, schema, form, list of
// methods and the options of an answer. A default stands once, in the struct.
#pragma once

#include <complex>
#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "engine/callable.h"
#include "engine/tuning/method/options.h"

namespace tunewright {

/// What a number must keep, and its unit ("time", "u/y", ...).
struct NumberOption {
    std::string unit = {};
    std::optional<double> minimum = {}, exclusive_minimum = {}, maximum = {};
    bool required = false;
    std::optional<double> otherwise = {};  ///< what an empty member stands for, where that is one number
};

/// The words of an enumeration, in the order in which they are listed.
template <class E>
using Words = std::vector<std::pair<std::string, E>>;

/// The first word of a value; "" where it has none.
template <class E>
std::string word_of(const Words<E>& words, const E& value) {
    for (const auto& [word, known] : words)
        if (known == value) return word;
    return {};
}

namespace detail {

template <class M>
struct Content {
    using type = M;
};
template <class M>
struct Content<std::optional<M>> {
    using type = M;
};

/// The value that stands in a member; null where it is an empty optional.
template <class M>
const M* content(const M& member) {
    return &member;
}
template <class M>
const M* content(const std::optional<M>& member) {
    return member ? &*member : nullptr;
}

}  // namespace detail

/// The members of `T` (default-constructed: every option left out) under the names of the contract. A member of type
/// std::optional has no default of its own: its sentence says what is taken instead.
template <class T>
class OptionSet {
public:
    explicit OptionSet(T defaults = {}) : defaults_(std::move(defaults)) {}

    const T& defaults() const { return defaults_; }
    const std::vector<OptionDescription>& descriptions() const { return descriptions_; }

    /// The struct that was asked for. `given` suits the descriptions; `prefix`: the path of the object that holds the
    /// options, "" or with a slash at its end.
    T read(const MethodOptions& given, const std::string& prefix = {}) const {
        T value = defaults_;
        for (const Binding& binding : bindings_) binding.read(given, prefix, value);
        return value;
    }

    /// What a request gives for `value`: its numbers, switches and words that differ from the defaults, or from
    /// `other`.
    MethodOptions given_for(const T& value) const { return given_for(value, defaults_); }
    MethodOptions given_for(const T& value, const T& other) const {
        MethodOptions given;
        for (const Binding& binding : bindings_)
            if (binding.write) binding.write(value, other, given);
        return given;
    }

    /// A double or int, or one of these that may be left out.
    template <class M>
    OptionSet& number(M T::*member, const std::string& name, const std::string& sentence,
                      const NumberOption& how = {}) {
        using Number = typename detail::Content<M>::type;
        const auto type = std::is_same_v<Number, int> ? OptionType::integer : OptionType::number;
        OptionDescription option = described(type, name, sentence, how);
        if (const Number* value = detail::content(defaults_.*member); value != nullptr && !how.required)
            option.default_value = static_cast<double>(*value);
        else if (how.otherwise)
            option.default_value = *how.otherwise;
        return add(
            std::move(option), member,
            [](const MethodOptions& given, const std::string& path) -> std::optional<Number> {
                const auto number = given.number(path);
                return number ? std::optional(static_cast<Number>(*number)) : std::nullopt;
            },
            [](const Number& value) { return OptionValue(static_cast<double>(value)); });
    }

    /// A bool, or one that may be left out.
    template <class M>
    OptionSet& flag(M T::*member, const std::string& name, const std::string& sentence) {
        OptionDescription option = described(OptionType::boolean, name, sentence);
        if (const bool* value = detail::content(defaults_.*member)) option.default_value = *value;
        return add(
            std::move(option), member,
            [](const MethodOptions& given, const std::string& path) { return given.boolean(path); },
            [](bool value) { return OptionValue(value); });
    }

    template <class E>
    OptionSet& choice(E T::*member, const std::string& name, const std::string& sentence, Words<E> words) {
        OptionDescription option = described(OptionType::choice, name, sentence);
        for (const auto& [word, value] : words) {
            option.choices.push_back(word);
            if (value == defaults_.*member) option.default_value = word;
        }
        return add(
            std::move(option), member,
            [words](const MethodOptions& given, const std::string& path) -> std::optional<E> {
                const auto chosen = given.text(path);
                for (const auto& [word, value] : words)
                    if (chosen == word) return value;
                return std::nullopt;
            },
            [words](const E& value) { return OptionValue(word_of(words, value)); });
    }

    /// A number, or `word`, for which the member is empty.
    OptionSet& number_or_word(std::optional<double> T::*member, const std::string& name, const std::string& sentence,
                              const std::string& word, const NumberOption& how = {}) {
        OptionDescription option = described(OptionType::number_or_word, name, sentence, how);
        option.choices = {word};
        if (const auto& value = defaults_.*member) option.default_value = *value;
        const std::string own = option.name;
        descriptions_.push_back(std::move(option));
        bindings_.push_back({[own, member](const MethodOptions& given, const std::string& prefix, T& value) {
                                 if (given.has(prefix + own)) value.*member = given.number(prefix + own);
                             },
                             [own, member, word](const T& value, const T& other, MethodOptions& given) {
                                 const std::optional<double>& number = value.*member;
                                 if (number == other.*member) return;
                                 given.set(own, number ? OptionValue(*number) : OptionValue(word));
                             }});
        return *this;
    }

    /// [low, high], low < high.
    template <class M>
    OptionSet& range(M T::*member, const std::string& name, const std::string& sentence, const NumberOption& how = {}) {
        return add(described(OptionType::range, name, sentence, how), member,
                   [](const MethodOptions& given, const std::string& path) { return given.range(path); });
    }

    OptionSet& number_or_range(std::optional<std::variant<double, NumberRange>> T::*member, const std::string& name,
                               const std::string& sentence, const NumberOption& how = {}) {
        using Value = std::variant<double, NumberRange>;
        return add(described(OptionType::number_or_range, name, sentence, how), member,
                   [](const MethodOptions& given, const std::string& path) -> std::optional<Value> {
                       if (const auto range = given.range(path)) return Value(*range);
                       if (const auto number = given.number(path)) return Value(*number);
                       return std::nullopt;
                   });
    }

    /// Numbers under names that the request chooses.
    OptionSet& numbers_by_name(std::map<std::string, double> T::*member, const std::string& name,
                               const std::string& sentence) {
        return add(described(OptionType::numbers_by_name, name, sentence), member,
                   [](const MethodOptions& given, const std::string& path) {
                       std::map<std::string, double> numbers;
                       const std::string below = path + "/";
                       for (const std::string& own : given.names(path))
                           numbers[own] = given.number(below + own).value_or(0);
                       return std::optional(std::move(numbers));
                   });
    }

    /// Numbers or pairs [re, im], at most `most`; `element` describes one.
    OptionSet& complex_list(std::vector<std::complex<double>> T::*member, const std::string& name,
                            const std::string& sentence, OptionDescription element, int most) {
        element.type = OptionType::complex;
        return list(member, name, sentence, std::move(element), most,
                    [](const MethodOptions& given, const std::string& path) {
                        if (const auto real = given.number(path)) return std::complex<double>(*real);
                        return std::complex<double>(given.number(path + "/0").value_or(0),
                                                    given.number(path + "/1").value_or(0));
                    });
    }

    OptionSet& text_list(std::vector<std::string> T::*member, const std::string& name, const std::string& sentence,
                         OptionDescription element, int most) {
        element.type = OptionType::text;
        return list(member, name, sentence, std::move(element), most,
                    [](const MethodOptions& given, const std::string& path) { return given.text(path).value_or(""); });
    }

    template <class E>
    OptionSet& object_list(std::vector<E> T::*member, const std::string& name, const std::string& sentence,
                           OptionDescription element, const OptionSet<E>& set, int most) {
        element.type = OptionType::object;
        element.fields = set.descriptions();
        return list(member, name, sentence, std::move(element), most,
                    [set](const MethodOptions& given, const std::string& path) { return set.read(given, path + "/"); });
    }

    /// A struct under a name of its own, or one that may be left out; with `at_most_fields` > 0 no more of them may be
    /// given.
    template <class M>
    OptionSet& object(M T::*member, const std::string& name, const std::string& sentence,
                      const OptionSet<typename detail::Content<M>::type>& set, int at_most_fields = 0) {
        OptionDescription option = described(OptionType::object, name, sentence);
        option.fields = set.descriptions();
        option.at_most_fields = at_most_fields;
        bind_part(member, set, option.name + "/");
        descriptions_.push_back(std::move(option));
        return *this;
    }

    /// A struct whose options stand among this one's, as several methods share them.
    template <class E>
    OptionSet& embed(E T::*member, const OptionSet<E>& set) {
        bind_part(member, set, "");
        descriptions_.insert(descriptions_.end(), set.descriptions().begin(), set.descriptions().end());
        return *this;
    }

private:
    struct Binding {
        Callable<void(const MethodOptions&, const std::string& prefix, T&)> read;
        /// Empty: given_for() leaves the member out.
        Callable<void(const T& value, const T& other, MethodOptions&)> write = {};
    };

    static OptionDescription described(OptionType type, const std::string& name, const std::string& sentence,
                                       const NumberOption& how = {}) {
        OptionDescription option;
        option.name = name;
        option.type = type;
        option.sentence = sentence;
        option.unit = how.unit;
        option.minimum = how.minimum;
        option.exclusive_minimum = how.exclusive_minimum;
        option.maximum = how.maximum;
        option.required = how.required;
        return option;
    }

    /// `take` gives the member's content where the request has it; `as_value`, if any, is the way back.
    template <class M, class Take, class AsValue = std::nullptr_t>
    OptionSet& add(OptionDescription option, M T::*member, Take take, AsValue as_value = {}) {
        const std::string name = option.name;
        descriptions_.push_back(std::move(option));
        Binding binding{[name, member, take](const MethodOptions& given, const std::string& prefix, T& value) {
            if (auto content = take(given, prefix + name)) value.*member = std::move(*content);
        }};
        if constexpr (!std::is_same_v<AsValue, std::nullptr_t>) {
            binding.write = [name, member, as_value](const T& value, const T& other, MethodOptions& given) {
                const auto* content = detail::content(value.*member);
                if (content != nullptr && value.*member != other.*member) given.set(name, as_value(*content));
            };
        }
        bindings_.push_back(std::move(binding));
        return *this;
    }

    template <class M>
    void bind_part(M T::*member, const OptionSet<typename detail::Content<M>::type>& set, const std::string& own) {
        constexpr bool kMayBeEmpty = !std::is_same_v<M, typename detail::Content<M>::type>;
        bindings_.push_back({[own, member, set](const MethodOptions& given, const std::string& outer, T& value) {
                                 const std::string path = outer + own;
                                 if (kMayBeEmpty && given.names(path.substr(0, path.size() - 1)).empty()) return;
                                 value.*member = set.read(given, path);
                             },
                             [own, member, set](const T& value, const T& other, MethodOptions& given) {
                                 const auto *part = detail::content(value.*member),
                                            *beside = detail::content(other.*member);
                                 if (part == nullptr) return;
                                 const MethodOptions inner = set.given_for(*part, beside ? *beside : set.defaults());
                                 for (const auto& [path, content] : inner.values()) given.set(own + path, content);
                             }});
    }

    template <class E, class Take>
    OptionSet& list(std::vector<E> T::*member, const std::string& name, const std::string& sentence,
                    OptionDescription element, int most, Take take) {
        OptionDescription option = described(OptionType::list, name, sentence);
        option.fields = {std::move(element)};
        option.most = most;
        const std::string own = option.name;
        descriptions_.push_back(std::move(option));
        bindings_.push_back({[own, member, take](const MethodOptions& given, const std::string& prefix, T& value) {
            for (std::size_t i = 0; i < given.size(prefix + own); ++i)
                (value.*member).push_back(take(given, prefix + own + "/" + std::to_string(i)));
        }});
        return *this;
    }

    T defaults_;
    std::vector<OptionDescription> descriptions_;
    std::vector<Binding> bindings_;
};

}  // namespace tunewright
