// A method's struct of options with the description of each member: decoding, schema, form, list of methods and the
// options of an answer follow from it. A default is defined once, in the struct.
#pragma once

#include <complex>
#include <cstddef>
#include <initializer_list>
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

/// Evenly between the limits of the number; about its value where it has only a lower limit.
OptionSlider slider_within(const OptionDescription& number);

/// Logarithmic, a factor in either direction.
OptionSlider slider_about_value();

namespace detail {

/// The value that stands in a member; null where it is an empty optional.
template <class M>
const M* content(const M& member) {
    return &member;
}
template <class M>
const M* content(const std::optional<M>& member) {
    return member ? &*member : nullptr;
}
template <class M>
using Content = std::remove_cvref_t<decltype(*content(std::declval<const M&>()))>;

/// The type of the option that a member of this type holds.
template <class M>
constexpr OptionType option_type() {
    if (std::is_same_v<M, int>) return OptionType::integer;
    if (std::is_same_v<M, bool>) return OptionType::boolean;
    if (std::is_same_v<M, std::string>) return OptionType::text;
    if (std::is_same_v<M, NumberRange>) return OptionType::range;
    if (std::is_same_v<M, std::variant<double, NumberRange>>) return OptionType::number_or_range;
    return std::is_same_v<M, std::map<std::string, double>> ? OptionType::numbers_by_name : OptionType::number;
}

/// Fills the member with the value given at `path`; false: none is given.
bool take(const MethodOptions& given, const std::string& path, double& member);
bool take(const MethodOptions& given, const std::string& path, int& member);
bool take(const MethodOptions& given, const std::string& path, bool& member);
bool take(const MethodOptions& given, const std::string& path, std::string& member);
bool take(const MethodOptions& given, const std::string& path, std::complex<double>& member);
bool take(const MethodOptions& given, const std::string& path, NumberRange& member);
bool take(const MethodOptions& given, const std::string& path, std::variant<double, NumberRange>& member);
bool take(const MethodOptions& given, const std::string& path, std::map<std::string, double>& member);
template <class M>
bool take(const MethodOptions& given, const std::string& path, std::optional<M>& member) {
    M content{};
    if (!take(given, path, content)) return false;
    member = std::move(content);
    return true;
}

/// The value that a request gives for a member with a number or a truth value; empty for other members.
template <class M>
std::optional<OptionValue> as_given(const M& member) {
    const auto* value = content(member);
    if (value == nullptr) return std::nullopt;
    if constexpr (std::is_same_v<Content<M>, bool>)
        return *value;
    else if constexpr (std::is_arithmetic_v<Content<M>>)
        return static_cast<double>(*value);
    else
        return std::nullopt;
}

}  // namespace detail

/// The part of OptionSet that does not depend on the type of the struct, so that it is compiled once.
class OptionList {
public:
    const std::vector<OptionDescription>& descriptions() const { return descriptions_; }

    /// The description at this path ("Ms", "filter/Tf"), which must exist; valid until the next option is added.
    OptionDescription& described(std::string_view path);

    /// Fills the members of the struct at `value` for which `given` has a value.
    void read(const MethodOptions& given, const std::string& prefix, void* value) const;
    /// The options with which a request gets the struct at `value` instead of the one at `other`.
    MethodOptions given_for(const void* value, const void* other) const;

    /// The next option, in a member of type M; `take` fills it, and `as_given` returns the value that a request gives
    /// for it.
    template <class M, class Take, class AsGiven>
    void add(OptionDescription option, std::ptrdiff_t offset, Take take, AsGiven as_given) {
        bindings_.push_back(
            {describe(std::move(option)).name, offset,
             [take](const MethodOptions& given, const std::string& path, void* member) {
                 take(given, path, *static_cast<M*>(member));
             },
             [as_given](const std::string& path, const void* member, const void* other, MethodOptions& given) {
                 const auto value = as_given(*static_cast<const M*>(member));
                 if (value && value != as_given(*static_cast<const M*>(other))) given.set(path, *value);
             }});
    }
    template <class M>
    void add(OptionDescription option, std::ptrdiff_t offset) {
        add<M>(
            std::move(option), offset,
            [](const MethodOptions& given, const std::string& path, M& member) { detail::take(given, path, member); },
            [](const M& member) { return detail::as_given(member); });
    }

    /// The next option, a list; `take` fills an element.
    template <class E, class Take>
    void add_list(std::string_view name, std::string_view sentence, OptionDescription element, int max,
                  std::ptrdiff_t offset, Take take) {
        OptionDescription option = described_option(OptionType::list, name, sentence);
        option.fields = {std::move(element)};
        option.max = max;
        add<std::vector<E>>(
            std::move(option), offset,
            [take](const MethodOptions& given, const std::string& path, std::vector<E>& member) {
                const std::size_t size = given.size(path);
                for (std::size_t i = 0; i < size; ++i)
                    take(given, path + "/" + std::to_string(i), member.emplace_back());
            },
            [](const std::vector<E>&) { return std::optional<OptionValue>(); });
    }

    /// The options of a set for a member that is a struct or may be one; `below` stands between `name` and their names.
    template <class M, class Set>
    void add_part(const std::string& name, const std::string& below, std::ptrdiff_t offset, const Set& set) {
        bindings_.push_back(
            {name, offset,
             [set, below](const MethodOptions& given, const std::string& path, void* member) {
                 if (!std::is_same_v<M, detail::Content<M>> && given.names(path).empty()) return;
                 *static_cast<M*>(member) = set.read(given, path + below);
             },
             [set, below](const std::string& path, const void* member, const void* other, MethodOptions& given) {
                 const auto *part = detail::content(*static_cast<const M*>(member)),
                            *compared = detail::content(*static_cast<const M*>(other));
                 if (part == nullptr) return;
                 const MethodOptions inner = set.given_for(*part, compared ? *compared : set.defaults());
                 for (const auto& [own, value] : inner.values()) given.set(path + below + own, value);
             }});
    }
    OptionDescription& describe(OptionDescription option) { return descriptions_.emplace_back(std::move(option)); }

private:
    struct Binding {
        std::string name;
        std::ptrdiff_t offset;
        Callable<void(const MethodOptions&, const std::string& path, void* member)> read;
        Callable<void(const std::string& path, const void* member, const void* other, MethodOptions&)> write;
    };

    std::vector<OptionDescription> descriptions_;
    std::vector<Binding> bindings_;
};

/// The members of `T` under their names; a default-constructed `T` has no option set. A member of type std::optional
/// has no default of its own: its description says what is used instead.
template <class T>
class OptionSet {
public:
    explicit OptionSet(T defaults = {}) : defaults_(std::move(defaults)) {}

    const T& defaults() const { return defaults_; }
    const std::vector<OptionDescription>& descriptions() const { return list_.descriptions(); }

    /// The requested struct. `given` must fit the descriptions; `prefix`: the path of the object with the options, ""
    /// or with a slash at its end.
    T read(const MethodOptions& given, const std::string& prefix = {}) const {
        T value = defaults_;
        list_.read(given, prefix, &value);
        return value;
    }

    /// The options that give `value`: its numbers, switches and words that differ from the defaults, or from `other`.
    MethodOptions given_for(const T& value) const { return given_for(value, defaults_); }
    MethodOptions given_for(const T& value, const T& other) const { return list_.given_for(&value, &other); }

    /// A number, a truth value, a NumberRange (low < high), either a number or a range, numbers under names that the
    /// request chooses, or one of these that may be left out.
    template <class M>
    OptionSet& field(M T::*member, std::string_view name, std::string_view sentence, const NumberOption& how = {}) {
        list_.add<M>(described_option(detail::option_type<detail::Content<M>>(), name, sentence, how,
                                      detail::as_given(defaults_.*member)),
                     offset_of(defaults_, member));
        return *this;
    }

    template <class E>
    OptionSet& choice(E T::*member, std::string_view name, std::string_view sentence, const Words<E>& words) {
        const auto as_given = [words](const E& value) { return std::optional<OptionValue>(word_of(words, value)); };
        OptionDescription option =
            described_option(OptionType::choice, name, sentence, {}, as_given(defaults_.*member));
        for (const auto& [word, value] : words) option.choices.push_back(word);
        const auto take = [words](const MethodOptions& given, const std::string& path, E& target) {
            const auto chosen = given.text(path);
            for (const auto& [word, value] : words)
                if (chosen == word) target = value;
        };
        list_.add<E>(std::move(option), offset_of(defaults_, member), take, as_given);
        return *this;
    }

    /// A number, or `word`, for which the member is empty.
    OptionSet& number_or_word(std::optional<double> T::*member, std::string_view name, std::string_view sentence,
                              std::string_view word, const NumberOption& how = {}) {
        OptionDescription option =
            described_option(OptionType::number_or_word, name, sentence, how, detail::as_given(defaults_.*member));
        option.choices = {std::string(word)};
        list_.add<std::optional<double>>(
            std::move(option), offset_of(defaults_, member),
            [](const MethodOptions& given, const std::string& path, std::optional<double>& target) {
                if (given.has(path)) target = given.number(path);
            },
            [word = std::string(word)](const std::optional<double>& number) {
                return std::optional(number ? OptionValue(*number) : OptionValue(word));
            });
        return *this;
    }

    /// At most `max` numbers or pairs [re, im], or texts; `element` describes one.
    template <class E>
    OptionSet& list(std::vector<E> T::*member, std::string_view name, std::string_view sentence,
                    OptionDescription element, int max) {
        list_.add_list<E>(
            name, sentence, std::move(element), max, offset_of(defaults_, member),
            [](const MethodOptions& given, const std::string& path, E& one) { detail::take(given, path, one); });
        return *this;
    }
    /// At most `max` structs.
    template <class E>
    OptionSet& list(std::vector<E> T::*member, std::string_view name, std::string_view sentence,
                    OptionDescription element, int max, const OptionSet<E>& set) {
        element.fields = set.descriptions();
        list_.add_list<E>(
            name, sentence, std::move(element), max, offset_of(defaults_, member),
            [set](const MethodOptions& given, const std::string& path, E& one) { one = set.read(given, path + "/"); });
        return *this;
    }

    /// A struct under its own name, or an optional one; with `at_most_fields` > 0 at most that number of fields may be
    /// given.
    template <class M>
    OptionSet& object(M T::*member, std::string_view name, std::string_view sentence,
                      const OptionSet<detail::Content<M>>& set, int at_most_fields = 0) {
        OptionDescription& option = list_.describe(described_option(OptionType::object, name, sentence));
        option.fields = set.descriptions();
        option.at_most_fields = at_most_fields;
        list_.add_part<M>(option.name, "/", offset_of(defaults_, member), set);
        return *this;
    }

    /// A struct whose options are on the same level as this one's, because several methods share them.
    template <class E>
    OptionSet& embed(E T::*member, const OptionSet<E>& set) {
        for (const OptionDescription& option : set.descriptions()) list_.describe(option);
        list_.add_part<E>("", "", offset_of(defaults_, member), set);
        return *this;
    }

    /// The options of these names, which must be described already, are the main ones.
    OptionSet& main(std::initializer_list<std::string_view> names) {
        for (const std::string_view name : names) list_.described(name).main = true;
        return *this;
    }

    /// Each of these options determines `other`; a request must not give both.
    OptionSet& in_place_of(std::string_view other, std::initializer_list<std::string_view> names) {
        for (const std::string_view name : names) list_.described(name).in_place_of = other;
        return *this;
    }

    /// The option adds data for plots of a page.
    OptionSet& draws(std::string_view name) {
        list_.described(name).draws = true;
        return *this;
    }

    /// The number at `path` ("Ms", "filter/Tf") has a slider; by default evenly between its limits, or around its value
    /// if it has only a lower one.
    OptionSet& slider(std::string_view path) { return slider(path, slider_within(list_.described(path))); }
    OptionSet& slider(std::string_view path, OptionSlider slider) {
        list_.described(path).slider = std::move(slider);
        return *this;
    }

private:
    T defaults_;
    OptionList list_;
};

}  // namespace tunewright
