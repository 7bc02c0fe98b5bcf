// Codecs that read, write and describe one JSON value of the contract; descriptions combine them.
#pragma once

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "api/describe/reader.h"
#include "api/describe/suggest.h"
#include "api/json/json.h"
#include "api/json/writer.h"
#include "engine/callable.h"
#include "engine/figure.h"
#include "engine/member.h"

namespace tunewright::api {

/// Collects the schemas of named types while the document is built.
struct SchemaBook {
    Json components = Json::object();
};

using SchemaOf = Callable<Json(SchemaBook&)>;

/// One kind of value. If the value is not valid, reading leaves the target unchanged and reports to the reader.
template <class T>
struct Codec {
    Callable<void(const Json&, T&, Reader&)> read;  ///< empty: for answers only
    Callable<void(const T&, Writer&)> write;
    SchemaOf schema;
    Callable<bool(const T&)> skip = {};       ///< true: the member is left out when written; empty: never
    Callable<bool(const T&)> undefined = {};  ///< true: written as null, which `why_null` must explain
    /// The reason of an undefined value; empty, or "": the description's general reason.
    Callable<std::string(const T&)> why = {};
};

/// The largest absolute value of a number, so that products of a few stay finite.
constexpr double kLargestNumber = 1e30;

/// Reads a number, or reports why it is not valid, with the rule. These sentences are written nowhere else.
std::optional<double> read_number(const Json& value, const NumberRule& rule, Reader& reader);
Json number_schema(const NumberRule& rule);

/// The sentence for a value of the wrong type: "K is "2", a text; it must be a number. Write 2 without quotes."
std::string wrong_kind(const Json& value, const std::string& wanted, const Reader& reader);

Codec<double> number(const NumberRule& rule = {});

/// A number whose rule the engine checks, with its own sentence: the schema shows the rule, reading accepts any number.
Codec<double> engine_ruled(const NumberRule& rule);
/// The rule has limits, which an int can hold.
Codec<int> integer(const NumberRule& rule);
inline Codec<int> integer(int minimum, int maximum) { return integer({.minimum = minimum, .maximum = maximum}); }
Codec<bool> boolean();
Codec<std::string> text(std::size_t longest);

/// For answers only: a text of any length.
Codec<std::string> words();

/// A number, or null for "infinite", as with Ti.
Codec<double> number_or_infinite(const NumberRule& rule, const std::string& meaning_of_null);

/// An array of numbers, `min` to `max` of them. The first five faults are listed.
Codec<std::vector<double>> numbers(std::size_t min, std::size_t max, const NumberRule& rule = {});

/// For answers only: six significant digits each.
Codec<std::vector<double>> trace();

/// For answers only: six significant digits, or more if neighbours would be equal.
Codec<std::vector<double>> times_trace();

/// For answers only: null if undefined or infinite, with the figure's reason.
Codec<Figure> figure();

/// A figure without a reason of its own.
Codec<std::optional<double>> nullable_number();
Codec<std::optional<bool>> nullable_bool();

/// The schema of a value that may be null.
SchemaOf or_null(SchemaOf inner);

/// For answers only: the value as `inner` writes it, or null with its reason.
template <class T>
Codec<OrReason<T>> or_reason(const Codec<T>& inner) {
    Codec<OrReason<T>> codec;
    codec.write = [write = inner.write](const OrReason<T>& value, Writer& out) {
        value ? write(*value, out) : out.null();
    };
    codec.schema = or_null(inner.schema);
    codec.undefined = [](const OrReason<T>& value) { return !value; };
    codec.why = [](const OrReason<T>& value) { return value.why; };
    return codec;
}

/// For answers only: numbers by name.
Codec<std::map<std::string, double>> numbers_by_name(std::string keys);

/// The member may be missing; an empty value is left out when written.
template <class T>
Codec<std::optional<T>> maybe(Codec<T> inner) {
    Codec<std::optional<T>> codec;
    if (inner.read) {
        codec.read = [read = inner.read](const Json& value, std::optional<T>& target, Reader& reader) {
            T content{};
            read(value, content, reader);
            target = std::move(content);
        };
    }
    codec.write = [write = inner.write](const std::optional<T>& value, Writer& out) { write(*value, out); };
    codec.schema = inner.schema;
    codec.skip = [](const std::optional<T>& value) { return !value.has_value(); };
    return codec;
}

/// An optional member of answers only.
template <class T>
Codec<T> only_answered(Codec<T> codec) {
    codec.read = {};
    return codec;
}

/// The member is left out if `empty` is true.
template <class T>
Codec<T> unless(Codec<T> codec, Callable<bool(const T&)> empty) {
    codec.skip = std::move(empty);
    return codec;
}

/// The allowed words of a choice.
struct ChoiceWords {
    std::vector<std::string> names;

    /// The index of the word that the value is; reports to the reader if it is none of them.
    std::optional<std::size_t> read(const Json& value, Reader& reader) const;
    SchemaOf schema() const;
};

/// Words of the contract for the values of an enumeration; if a value has several, the first is written.
template <class E>
Codec<E> choice(const Words<E>& words) {
    ChoiceWords known;
    for (const auto& [word, meaning] : words) known.names.push_back(word);
    Codec<E> codec;
    codec.read = [known, words](const Json& value, E& target, Reader& reader) {
        if (const auto at = known.read(value, reader)) target = words[*at].second;
    };
    codec.write = [words](const E& value, Writer& out) {
        const std::string word = word_of(words, value);
        word.empty() ? out.null() : out.text(word);
    };
    codec.schema = known.schema();
    return codec;
}

/// The allowed lengths of an array.
struct ArrayLengths {
    std::size_t min, max;

    /// False: the value is not an array of an allowed length, which is reported.
    bool hold(const Json& value, Reader& reader) const;
    /// `stated`: with the allowed lengths.
    SchemaOf schema(SchemaOf items, bool stated) const;
};

/// An array of `min` to `max` values.
template <class T>
Codec<std::vector<T>> list_of(Codec<T> inner, std::size_t min = 0, std::size_t max = 100) {
    const ArrayLengths lengths{min, max};
    Codec<std::vector<T>> codec;
    if (inner.read) {
        codec.read = [read = inner.read, lengths](const Json& value, std::vector<T>& target, Reader& reader) {
            if (!lengths.hold(value, reader)) return;
            target.clear();
            target.resize(value.size());
            for (std::size_t i = 0; i < target.size(); ++i) {
                const Reader::At at(reader, i);
                read(value[i], target[i], reader);
            }
        };
    }
    codec.write = [write = inner.write](const std::vector<T>& values, Writer& out) {
        out.begin_array();
        for (const T& value : values) write(value, out);
        out.end_array();
    };
    codec.schema = lengths.schema(inner.schema, bool(inner.read));
    return codec;
}

}  // namespace tunewright::api
