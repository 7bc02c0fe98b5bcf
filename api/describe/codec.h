// How one JSON value of the contract is read, written and described: small codecs, put together by descriptions.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "api/describe/reader.h"
#include "api/describe/suggest.h"
#include "api/json/json.h"
#include "api/json/writer.h"
#include "engine/figure.h"

namespace tunewright::api {

/// Collects the schemas of named types while the document is put together.
struct SchemaBook {
    Json components = Json::object();
};

/// One kind of value. Reading leaves the target alone and reports to the reader where the value is not valid.
template <class T>
struct Codec {
    std::function<void(const Json&, T&, Reader&)> read;  ///< empty: only in answers
    std::function<void(const T&, Writer&)> write;
    std::function<Json(SchemaBook&)> schema;
    std::function<bool(const T&)> skip = {};       ///< true: the member is left out when written; empty: never
    std::function<bool(const T&)> undefined = {};  ///< true: written as null, which `why_null` has to explain
    /// The reason of an undefined value; empty, or "": the description's own for all.
    std::function<std::string(const T&)> why = {};
};

/// What a number must keep. Every number is finite and at most 1e30 in size, so that products of a few stay finite.
struct NumberRule {
    std::optional<double> minimum = {}, exclusive_minimum = {}, maximum = {}, exclusive_maximum = {};
    bool not_zero = false;
    std::string cure = {};  ///< a sentence that is added when the rule is broken
};

constexpr double kLargestNumber = 1e30;

/// Reads a number or reports why it is none; the rule included. The one place of these sentences.
std::optional<double> read_number(const Json& value, const NumberRule& rule, Reader& reader);
Json number_schema(const NumberRule& rule);

/// The sentence for a value of the wrong kind: "K is "2", a text; it must be a number. Write 2 without quotes."
std::string wrong_kind(const Json& value, const std::string& wanted, const Reader& reader);

Codec<double> number(const NumberRule& rule = {});

/// A number whose rule the engine holds, with its own sentence: the schema shows the rule, reading takes any number.
Codec<double> engine_ruled(const NumberRule& rule);
Codec<int> integer(int minimum, int maximum);
Codec<bool> boolean();
Codec<std::string> text(std::size_t longest);

/// Only in answers: a text of any length.
Codec<std::string> words();

/// A number or null for "infinite", as with Ti.
Codec<double> number_or_infinite(const NumberRule& rule, const std::string& meaning_of_null);

/// An array of numbers, `least` to `most` of them. The first five faults are listed.
Codec<std::vector<double>> numbers(std::size_t least, std::size_t most, const NumberRule& rule = {});

/// Only in answers: six significant digits each.
Codec<std::vector<double>> trace();

/// Only in answers: six significant digits, or as many as neighbours differ by.
Codec<std::vector<double>> times_trace();

/// Only in answers: null where undefined or infinite, with the figure's reason.
Codec<Figure> figure();

/// The same of values that state no reason of their own.
Codec<std::optional<double>> nullable_number();
Codec<std::optional<bool>> nullable_bool();

/// Only in answers: the value as `inner` writes it, or null with its reason.
template <class T>
Codec<OrReason<T>> or_reason(const Codec<T>& inner) {
    Codec<OrReason<T>> codec;
    codec.write = [write = inner.write](const OrReason<T>& value, Writer& out) {
        value ? write(*value, out) : out.null();
    };
    codec.schema = [schema = inner.schema](SchemaBook& book) {
        return Json{{"oneOf", {schema(book), Json{{"type", "null"}}}}};
    };
    codec.undefined = [](const OrReason<T>& value) { return !value; };
    codec.why = [](const OrReason<T>& value) { return value.why; };
    return codec;
}

/// Only in answers: numbers by name.
Codec<std::map<std::string, double>> numbers_by_name(std::string keys);

/// The member may be missing; it is then left out when written too.
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

/// The same value where only answers carry it.
template <class T>
Codec<T> only_answered(Codec<T> codec) {
    codec.read = {};
    return codec;
}

/// The member is left out where `empty` holds.
template <class T>
Codec<T> unless(Codec<T> codec, std::function<bool(const T&)> empty) {
    codec.skip = std::move(empty);
    return codec;
}

/// Words of the contract for the values of an enumeration, the first written for each value.
template <class E>
Codec<E> choice(std::vector<std::pair<std::string, E>> words) {
    std::vector<std::string> names;
    names.reserve(words.size());
    for (const auto& [word, value] : words) names.push_back(word);
    Codec<E> codec;
    codec.read = [words, names](const Json& value, E& target, Reader& reader) {
        if (value.is_string()) {
            for (const auto& [word, meaning] : words) {
                if (value.get_ref<const std::string&>() == word) {
                    target = meaning;
                    return;
                }
            }
        }
        const std::string meant = value.is_string() ? nearest(value.get_ref<const std::string&>(), names) : "";
        reader.fault(reader.name() + " is " + shown(value) + "; it must be " + listed(names) + "." +
                     (meant.empty() ? "" : " Did you mean " + meant + "?"));
    };
    codec.write = [words](const E& value, Writer& out) {
        for (const auto& [word, meaning] : words) {
            if (meaning == value) return out.text(word);
        }
        out.null();
    };
    codec.schema = [names](SchemaBook&) { return Json{{"type", "string"}, {"enum", names}}; };
    return codec;
}

/// An array of `least` to `most` values.
template <class T>
Codec<std::vector<T>> list_of(Codec<T> inner, std::size_t least = 0, std::size_t most = 100) {
    Codec<std::vector<T>> codec;
    if (inner.read) {
        codec.read = [read = inner.read, least, most](const Json& value, std::vector<T>& target, Reader& reader) {
            if (!value.is_array()) return reader.fault(wrong_kind(value, "an array", reader));
            if (value.size() < least || value.size() > most) {
                return reader.fault(reader.name() + " has " + std::to_string(value.size()) +
                                    " elements; it must have " + std::to_string(least) + " to " + std::to_string(most) +
                                    ".");
            }
            target.clear();
            target.reserve(value.size());
            for (std::size_t i = 0; i < value.size(); ++i) {
                const Reader::At at(reader, i);
                T element{};
                read(value[i], element, reader);
                target.push_back(std::move(element));
            }
        };
    }
    codec.write = [write = inner.write](const std::vector<T>& values, Writer& out) {
        out.begin_array();
        for (const T& value : values) write(value, out);
        out.end_array();
    };
    codec.schema = [schema = inner.schema, least, most, reads = bool(inner.read)](SchemaBook& book) {
        Json out{{"type", "array"}, {"items", schema(book)}};
        if (reads) {
            out["minItems"] = least;
            out["maxItems"] = most;
        }
        return out;
    };
    return codec;
}

}  // namespace tunewright::api
