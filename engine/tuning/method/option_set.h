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
#include <utility>
#include <variant>
#include <vector>

#include "engine/tuning/method/option_list.h"
#include "engine/tuning/method/options.h"

namespace tunewright {

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

    /// A double or int, or an optional one.
    template <class M>
    OptionSet& number(M T::*member, std::string_view name, std::string_view sentence, const NumberOption& how = {}) {
        list_.number(at(member), name, sentence, how);
        return *this;
    }

    /// A bool, or an optional one.
    template <class M>
    OptionSet& flag(M T::*member, std::string_view name, std::string_view sentence) {
        list_.flag(at(member), name, sentence);
        return *this;
    }

    template <class E>
    OptionSet& choice(E T::*member, std::string_view name, std::string_view sentence, Words<E> words) {
        list_.choice(at(member), name, sentence, std::move(words));
        return *this;
    }

    /// A number, or `word`, for which the member is empty.
    OptionSet& number_or_word(std::optional<double> T::*member, std::string_view name, std::string_view sentence,
                              std::string_view word, const NumberOption& how = {}) {
        list_.number_or_word(at(member), name, sentence, word, how);
        return *this;
    }

    /// [low, high], low < high.
    template <class M>
    OptionSet& range(M T::*member, std::string_view name, std::string_view sentence, const NumberOption& how = {}) {
        list_.range(at(member), name, sentence, how);
        return *this;
    }

    OptionSet& number_or_range(std::optional<std::variant<double, NumberRange>> T::*member, std::string_view name,
                               std::string_view sentence, const NumberOption& how = {}) {
        list_.number_or_range(at(member), name, sentence, how);
        return *this;
    }

    /// Numbers under names that the request chooses.
    OptionSet& numbers_by_name(std::map<std::string, double> T::*member, std::string_view name,
                               std::string_view sentence) {
        list_.numbers_by_name(at(member), name, sentence);
        return *this;
    }

    /// Numbers or pairs [re, im], at most `max`; `element` describes one.
    OptionSet& complex_list(std::vector<std::complex<double>> T::*member, std::string_view name,
                            std::string_view sentence, const OptionDescription& element, int max) {
        list_.complex_list(at(member), name, sentence, element, max);
        return *this;
    }

    OptionSet& text_list(std::vector<std::string> T::*member, std::string_view name, std::string_view sentence,
                         const OptionDescription& element, int max) {
        list_.text_list(at(member), name, sentence, element, max);
        return *this;
    }

    template <class E>
    OptionSet& object_list(std::vector<E> T::*member, std::string_view name, std::string_view sentence,
                           const OptionDescription& element, const OptionSet<E>& set, int max) {
        list_.object_list(at(member), name, sentence, element, set, max);
        return *this;
    }

    /// A struct under its own name, or an optional one; with `at_most_fields` > 0 at most that number of fields may be
    /// given.
    template <class M>
    OptionSet& object(M T::*member, std::string_view name, std::string_view sentence,
                      const OptionSet<typename detail::Content<M>::type>& set, int at_most_fields = 0) {
        list_.object(at(member), name, sentence, set, at_most_fields);
        return *this;
    }

    /// A struct whose options are on the same level as this one's, because several methods share them.
    template <class E>
    OptionSet& embed(E T::*member, const OptionSet<E>& set) {
        list_.embed(at(member), set);
        return *this;
    }

    /// The options of these names, which must be described already, are the main ones.
    OptionSet& main(std::initializer_list<std::string_view> names) {
        for (const std::string_view name : names) list_.described(name).main = true;
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
    template <class M>
    detail::Member<M> at(M T::*member) const {
        const M& preset = defaults_.*member;
        return {static_cast<std::size_t>(reinterpret_cast<const char*>(&preset) -
                                         reinterpret_cast<const char*>(&defaults_)),
                preset};
    }

    T defaults_;
    OptionList list_;
};

}  // namespace tunewright
