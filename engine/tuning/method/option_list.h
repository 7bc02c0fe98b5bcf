// Described options of any struct: the common part of option_set.h, compiled once. A member is identified by its offset
// in its struct, so that methods share the code for members of the same type.
#pragma once

#include <complex>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "engine/callable.h"
#include "engine/tuning/method/options.h"

namespace tunewright {

/// The limits of a number, and its unit ("time", "u/y", ...).
struct NumberOption {
    std::string_view unit = {};
    std::optional<double> minimum = {}, exclusive_minimum = {}, maximum = {};
    bool required = false;
    std::optional<double> fallback = {};  ///< the meaning of an empty member, if it is one number
};

/// Evenly between the limits of the number; around its value if it has only a lower limit.
OptionSlider slider_within(const OptionDescription& number);

/// Logarithmic, a factor in either direction.
OptionSlider slider_about_value();

/// The words of an enumeration, in the order in which they are listed.
template <class E>
using Words = std::vector<std::pair<std::string, E>>;

/// The first word of a value; "" if it has none.
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

/// The value of a member; null for an empty optional.
template <class M>
const M* content(const M& member) {
    return &member;
}
template <class M>
const M* content(const std::optional<M>& member) {
    return member ? &*member : nullptr;
}

/// A member of a struct: its offset in bytes, and its value in the defaults.
template <class M>
struct Member {
    std::size_t offset;
    const M& preset;
};

}  // namespace detail

class OptionList {
public:
    template <class M>
    using Member = detail::Member<M>;

    const std::vector<OptionDescription>& descriptions() const { return descriptions_; }

    /// The description at this path ("Ms", "filter/Tf"), which must exist; valid until the next option is added.
    OptionDescription& described(std::string_view path);

    /// Sets the struct at `value`, of the members' type, from `given`.
    void read(const MethodOptions& given, const std::string& prefix, void* value) const;
    /// The options with which a request gets the struct at `value` instead of the one at `other`.
    MethodOptions given_for(const void* value, const void* other) const;

    template <class M>
    void number(const Member<M>& member, std::string_view name, std::string_view sentence, const NumberOption& how) {
        using Number = typename detail::Content<M>::type;
        const Number* preset = detail::content(member.preset);
        describe_number(std::is_same_v<Number, int> ? OptionType::integer : OptionType::number, name, sentence, how,
                        preset != nullptr ? std::optional<double>(*preset) : std::nullopt);
        bind<M>(
            member.offset, name,
            [](const MethodOptions& given, const std::string& path) -> std::optional<Number> {
                const auto number = given.number(path);
                return number ? std::optional(static_cast<Number>(*number)) : std::nullopt;
            },
            [](const Number& value) { return OptionValue(static_cast<double>(value)); });
    }

    template <class M>
    void flag(const Member<M>& member, std::string_view name, std::string_view sentence) {
        OptionDescription& option = describe(OptionType::boolean, name, sentence);
        if (const bool* preset = detail::content(member.preset)) option.default_value = *preset;
        bind<M>(
            member.offset, name,
            [](const MethodOptions& given, const std::string& path) { return given.boolean(path); },
            [](bool value) { return OptionValue(value); });
    }

    template <class E>
    void choice(const Member<E>& member, std::string_view name, std::string_view sentence, Words<E> words) {
        OptionDescription& option = describe(OptionType::choice, name, sentence);
        for (const auto& [word, value] : words) {
            option.choices.push_back(word);
            if (value == member.preset) option.default_value = word;
        }
        bind<E>(
            member.offset, name,
            [words](const MethodOptions& given, const std::string& path) -> std::optional<E> {
                const auto chosen = given.text(path);
                for (const auto& [word, value] : words)
                    if (chosen == word) return value;
                return std::nullopt;
            },
            [words](const E& value) { return OptionValue(word_of(words, value)); });
    }

    void number_or_word(const Member<std::optional<double>>& member, std::string_view name, std::string_view sentence,
                        std::string_view word, const NumberOption& how);

    template <class M>
    void range(const Member<M>& member, std::string_view name, std::string_view sentence, const NumberOption& how) {
        describe(OptionType::range, name, sentence, how);
        bind<M>(member.offset, name,
                [](const MethodOptions& given, const std::string& path) { return given.range(path); });
    }

    void number_or_range(const Member<std::optional<std::variant<double, NumberRange>>>& member, std::string_view name,
                         std::string_view sentence, const NumberOption& how);
    void numbers_by_name(const Member<std::map<std::string, double>>& member, std::string_view name,
                         std::string_view sentence);
    void complex_list(const Member<std::vector<std::complex<double>>>& member, std::string_view name,
                      std::string_view sentence, OptionDescription element, int max);
    void text_list(const Member<std::vector<std::string>>& member, std::string_view name, std::string_view sentence,
                   OptionDescription element, int max);

    /// `Set`: an OptionSet<E>.
    template <class E, class Set>
    void object_list(const Member<std::vector<E>>& member, std::string_view name, std::string_view sentence,
                     OptionDescription element, const Set& set, int max) {
        element.type = OptionType::object;
        element.fields = set.descriptions();
        describe_list(name, sentence, std::move(element), max);
        bind_list<E>(member.offset, name, [set](const MethodOptions& given, const std::string& path) {
            return set.read(given, path + "/");
        });
    }

    template <class M, class Set>
    void object(const Member<M>& member, std::string_view name, std::string_view sentence, const Set& set,
                int at_most_fields) {
        OptionDescription& option = describe(OptionType::object, name, sentence);
        option.fields = set.descriptions();
        option.at_most_fields = at_most_fields;
        bind_part<M>(member.offset, name, "/", set);
    }

    template <class E, class Set>
    void embed(const Member<E>& member, const Set& set) {
        describe_as(set.descriptions());
        bind_part<E>(member.offset, "", "", set);
    }

private:
    struct Binding {
        std::string name;
        std::size_t offset;
        Callable<void(const MethodOptions&, const std::string& path, void* member)> read;
        /// Empty: given_for() omits the member.
        Callable<void(const std::string& name, const void* member, const void* other, MethodOptions&)> write = {};
    };

    /// Adds a description and returns it for further settings; valid until the next one.
    OptionDescription& describe(OptionType type, std::string_view name, std::string_view sentence,
                                const NumberOption& how = {});
    void describe_number(OptionType type, std::string_view name, std::string_view sentence, const NumberOption& how,
                         std::optional<double> preset);
    void describe_list(std::string_view name, std::string_view sentence, OptionDescription element, int max);
    void describe_as(const std::vector<OptionDescription>& others);
    void add(Binding binding);

    /// `take` reads the member from the request; `as_value`, if given, is the inverse.
    template <class M, class Take, class AsValue = std::nullptr_t>
    void bind(std::size_t offset, std::string_view name, Take take, AsValue as_value = {}) {
        Binding binding{std::string(name), offset,
                        [take](const MethodOptions& given, const std::string& path, void* member) {
                            if (auto content = take(given, path)) *static_cast<M*>(member) = std::move(*content);
                        }};
        if constexpr (!std::is_same_v<AsValue, std::nullptr_t>) {
            binding.write = [as_value](const std::string& own, const void* member, const void* other,
                                       MethodOptions& given) {
                const M& value = *static_cast<const M*>(member);
                const auto* content = detail::content(value);
                if (content != nullptr && value != *static_cast<const M*>(other)) given.set(own, as_value(*content));
            };
        }
        add(std::move(binding));
    }

    /// `below` separates this name from those of the set.
    template <class M, class Set>
    void bind_part(std::size_t offset, std::string_view name, const std::string& below, const Set& set) {
        constexpr bool kMayBeEmpty = !std::is_same_v<M, typename detail::Content<M>::type>;
        add({std::string(name), offset,
             [set, below](const MethodOptions& given, const std::string& path, void* member) {
                 if (kMayBeEmpty && given.names(path).empty()) return;
                 *static_cast<M*>(member) = set.read(given, path + below);
             },
             [set, below](const std::string& own, const void* member, const void* other, MethodOptions& given) {
                 const auto *part = detail::content(*static_cast<const M*>(member)),
                            *beside = detail::content(*static_cast<const M*>(other));
                 if (part == nullptr) return;
                 const MethodOptions inner = set.given_for(*part, beside ? *beside : set.defaults());
                 const std::string outer = own + below;
                 for (const auto& [path, content] : inner.values()) given.set(outer + path, content);
             }});
    }

    template <class E, class Take>
    void bind_list(std::size_t offset, std::string_view name, Take take) {
        add({std::string(name), offset, [take](const MethodOptions& given, const std::string& path, void* member) {
                 const std::size_t size = given.size(path);
                 for (std::size_t i = 0; i < size; ++i)
                     static_cast<std::vector<E>*>(member)->push_back(take(given, path + "/" + std::to_string(i)));
             }});
    }

    std::vector<OptionDescription> descriptions_;
    std::vector<Binding> bindings_;
};

}  // namespace tunewright
