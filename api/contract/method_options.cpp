#include "api/contract/method_options.h"

#include <algorithm>
#include <cctype>

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxTextLength = 1000;

/// The destination of an option's value.
struct OptionPlace {
    MethodOptions& options;
    std::string path;  ///< "" for the object of all options

    OptionPlace below(const std::string& name) const { return {options, path.empty() ? name : path + "/" + name}; }
};

/// Reads and describes an option; lives as long as its description.
using OptionCodec = Codec<OptionPlace>;

OptionCodec codec_of(const OptionDescription& option);
SchemaOf described_schema(const OptionDescription& option);

/// A value that a codec of the contract reads; kept where it found no fault.
template <class T>
OptionCodec single(const Codec<T>& codec) {
    return {[read = codec.read](const Json& value, OptionPlace& place, Reader& reader) {
                const std::size_t before = reader.count();
                T content{};
                read(value, content, reader);
                if (!reader.clean_since(before)) return;
                if constexpr (std::is_same_v<T, int>)
                    place.options.set(place.path, static_cast<double>(content));
                else
                    place.options.set(place.path, std::move(content));
            },
            {},
            codec.schema};
}

OptionCodec word(const OptionDescription& option) {
    Words<std::string> words;
    for (const std::string& word : option.choices) words.emplace_back(word, word);
    return single(choice(words));
}

OptionCodec number_or_word(const OptionDescription& option) {
    return {[&option](const Json& value, OptionPlace& place, Reader& reader) {
                NumberRule rule = option;
                rule.cure = "The word " + listed(option.choices) + " is possible too.";
                if (value.is_number()) return single(number(rule)).read(value, place, reader);
                const std::string word = value.is_string() ? value.get<std::string>() : "";
                if (std::ranges::find(option.choices, word) != option.choices.end())
                    return place.options.set(place.path, word);
                const std::string meant = nearest(word, option.choices);
                reader.fault(wrong_kind(value, "a number or the word " + listed(option.choices), reader) +
                             (meant.empty() ? "" : " Did you mean " + meant + "?"));
            },
            {},
            [&option](SchemaBook& book) {
                return Json{{"oneOf", {number_schema(option), word(option).schema(book)}}};
            }};
}

/// Two numbers, at the indices 0 and 1; `spelled`: "[low, high]", where the first is below the second, or "[re, im]".
OptionCodec pair(const OptionDescription& option, const std::string& spelled) {
    return {[&option, spelled](const Json& value, OptionPlace& place, Reader& reader) {
                if (!value.is_array()) return reader.fault(wrong_kind(value, spelled, reader));
                if (value.size() != 2)
                    return reader.fault(reader.name() + " has " + std::to_string(value.size()) +
                                        " elements; it must be " + spelled + ".");
                std::optional<double> numbers[2];
                for (std::size_t i = 0; i < 2; ++i) {
                    const Reader::At at(reader, i);
                    numbers[i] = read_number(value[i], option, reader);
                }
                if (!numbers[0] || !numbers[1]) return;
                if (option.type != OptionType::complex && !(*numbers[0] < *numbers[1]))
                    return reader.fault(reader.name() + " is " + shown(value) +
                                        "; the first number must be below the second.");
                for (std::size_t i = 0; i < 2; ++i) place.options.set(place.below(std::to_string(i)).path, *numbers[i]);
            },
            {},
            ArrayLengths{2, 2}.schema(number(option).schema, true)};
}

OptionCodec number_or_pair(const OptionDescription& option, const std::string& spelled) {
    const OptionCodec alone = single(number(option)), both = pair(option, "a number or " + spelled);
    return {[alone, both](const Json& value, OptionPlace& place, Reader& reader) {
                (value.is_number() ? alone : both).read(value, place, reader);
            },
            {},
            [alone, both](SchemaBook& book) {
                return Json{{"oneOf", {alone.schema(book), both.schema(book)}}};
            }};
}

OptionCodec list(const OptionDescription& option) {
    const ArrayLengths lengths{1, static_cast<std::size_t>(option.max)};
    return {
        [lengths, element = codec_of(option.fields.front())](const Json& value, OptionPlace& place, Reader& reader) {
            if (!lengths.hold(value, reader)) return;
            for (std::size_t i = 0; i < value.size(); ++i) {
                const Reader::At at(reader, i);
                OptionPlace below = place.below(std::to_string(i));
                element.read(value[i], below, reader);
            }
        },
        {},
        lengths.schema(described_schema(option.fields.front()), true)};
}

bool is_name(const std::string& text) {
    const auto in_name = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
    return !text.empty() && std::isdigit(static_cast<unsigned char>(text[0])) == 0 && text.size() <= kMaxTextLength &&
           std::all_of(text.begin(), text.end(), in_name);
}

void read_numbers_by_name(const Json& value, const OptionDescription& option, const OptionPlace& place,
                          Reader& reader) {
    if (!value.is_object()) return reader.fault(wrong_kind(value, "an object of numbers by name", reader));
    if (value.size() > static_cast<std::size_t>(option.max))
        return reader.fault(reader.name() + " has " + std::to_string(value.size()) + " names; it must have at most " +
                            std::to_string(option.max) + ".");
    for (const auto& [name, member] : value.items()) {
        if (!is_name(name)) {
            reader.fault_at(
                name, shown(Json(name)) +
                          " is not a valid name; a name has letters, digits and _, and does not begin with a digit.");
            continue;
        }
        const Reader::At at(reader, name);
        OptionPlace below = place.below(name);
        single(number(option)).read(member, below, reader);
    }
}

std::vector<std::string> names_of(const std::vector<OptionDescription>& options) {
    std::vector<std::string> names;
    names.reserve(options.size());
    for (const OptionDescription& option : options) names.push_back(option.name);
    return names;
}

void read_fields(const Json& value, const std::vector<OptionDescription>& described, const std::string& owner,
                 const OptionPlace& place, Reader& reader) {
    for (const auto& [name, member] : value.items()) {
        if (place.path.empty() && name == "method") continue;
        if (const OptionDescription* option = named(described, name)) {
            const Reader::At at(reader, name);
            OptionPlace below = place.below(name);
            codec_of(*option).read(member, below, reader);
        } else {
            reader.fault_at(name, unknown_option(name, owner, names_of(described)));
        }
    }
}

void read_object(const Json& value, const OptionDescription& option, const OptionPlace& place, Reader& reader) {
    const std::vector<std::string> names = names_of(option.fields);
    if (!value.is_object()) return reader.fault(wrong_kind(value, "an object with " + listed(names), reader));
    if (option.at_most_fields > 0 && value.size() > static_cast<std::size_t>(option.at_most_fields))
        return reader.fault(reader.name() + " has " + std::to_string(value.size()) + " fields; it must have at most " +
                            std::to_string(option.at_most_fields) + " of " + listed(names) + ".");
    for (const OptionDescription& field : option.fields)
        if (field.required && !value.contains(field.name)) reader.fault_at(field.name, field.name + " is missing.");
    read_fields(value, option.fields, reader.name(), place, reader);
}

Json object_schema(const OptionDescription& option) {
    Json schema = options_schema(option.fields);
    if (option.at_most_fields > 0) schema["maxProperties"] = option.at_most_fields;
    for (const OptionDescription& field : option.fields)
        if (field.required) schema["required"].push_back(field.name);
    return schema;
}

OptionCodec codec_of(const OptionDescription& option) {
    switch (option.type) {
        case OptionType::number: return single(number(option));
        case OptionType::integer: return single(integer(option));
        case OptionType::boolean: return single(boolean());
        case OptionType::choice: return word(option);
        case OptionType::text: return single(text(kMaxTextLength));
        case OptionType::number_or_word: return number_or_word(option);
        case OptionType::range: return pair(option, "[low, high]");
        case OptionType::number_or_range: return number_or_pair(option, "[low, high]");
        case OptionType::complex: return number_or_pair(option, "[re, im]");
        case OptionType::list: return list(option);
        case OptionType::numbers_by_name:
            return {[&option](const Json& value, OptionPlace& place, Reader& reader) {
                        read_numbers_by_name(value, option, place, reader);
                    },
                    {},
                    [&option](SchemaBook&) {
                        return Json{{"type", "object"},
                                    {"additionalProperties", number_schema(option)},
                                    {"maxProperties", option.max}};
                    }};
        case OptionType::object: break;
    }
    return {
        [&option](const Json& value, OptionPlace& place, Reader& reader) { read_object(value, option, place, reader); },
        {},
        [&option](SchemaBook&) { return object_schema(option); }};
}

Json to_json(const OptionValue& value) {
    return std::visit([](const auto& content) { return Json(content); }, value);
}

const char* name_of(DesignFigure figure) {
    switch (figure) {
        case DesignFigure::Mks: return "Mks";
        case DesignFigure::Tf: return "Tf";
        case DesignFigure::Tf_over_Td: return "Tf_over_Td";
        case DesignFigure::overshoot_percent: return "overshoot_percent";
        case DesignFigure::none: break;
    }
    return "";
}

Json to_json(const OptionSlider& slider) {
    Json json{{"from", slider.from}, {"to", slider.to}};
    const auto text = [&](const char* name, const std::string& value) {
        if (!value.empty()) json[name] = value;
    };
    if (slider.relative) json["relative"] = true;
    if (slider.logarithmic) json["logarithmic"] = true;
    if (slider.step) json["step"] = *slider.step;
    text("label", slider.label);
    text("low", slider.low);
    text("high", slider.high);
    text("group", slider.group);
    text("moves_with", slider.moves_with);
    text("value_of", name_of(slider.value_of));
    text("reached", name_of(slider.reached));
    return json;
}

SchemaOf described_schema(const OptionDescription& option) {
    return [&option](SchemaBook& book) {
        Json schema = codec_of(option).schema(book);
        if (!option.sentence.empty()) schema["description"] = option.sentence;
        if (!option.unit.empty()) schema["x-unit"] = option.unit;
        if (option.default_value) schema["default"] = to_json(*option.default_value);
        if (option.main) schema["x-main"] = true;
        if (!option.in_place_of.empty()) schema["x-in-place-of"] = option.in_place_of;
        if (option.draws) schema["x-draws"] = true;
        if (option.slider) schema["x-slider"] = to_json(*option.slider);
        return schema;
    };
}

}  // namespace

std::string unknown_option(const std::string& name, const std::string& owner, const std::vector<std::string>& names) {
    const std::string meant = nearest(name, names);
    return name + " is not an option of " + owner + "; " +
           (!meant.empty()  ? "did you mean " + meant + "?"
            : names.empty() ? "it has none."
                            : "its options are " + listed(names, "and") + ".");
}

Codec<MethodOptions> option_codec(const OptionDescription& option) {
    return {[&option, read = codec_of(option).read](const Json& value, MethodOptions& target, Reader& reader) {
                OptionPlace place{target, option.name};
                read(value, place, reader);
            },
            {},
            described_schema(option)};
}

void read_options(const Json& value, const std::vector<OptionDescription>& described, const std::string& owner,
                  MethodOptions& target, Reader& reader) {
    read_fields(value, described, owner, {target, ""}, reader);
}

void place_option(Json& object, const std::string& path, const OptionValue& value) {
    object[Json::json_pointer("/" + path)] = to_json(value);
}

Json options_schema(const std::vector<OptionDescription>& options) {
    SchemaBook none;  // options refer to no component
    Json properties = Json::object();
    for (const OptionDescription& option : options) properties[option.name] = described_schema(option)(none);
    return {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
}

}  // namespace tunewright::api
