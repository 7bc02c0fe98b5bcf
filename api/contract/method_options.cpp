#include "api/contract/method_options.h"

#include <algorithm>
#include <cctype>

namespace tunewright::api {
namespace {

constexpr std::size_t kMaxTextLength = 100;

NumberRule rule_of(const OptionDescription& option) {
    return {.minimum = option.minimum, .exclusive_minimum = option.exclusive_minimum, .maximum = option.maximum};
}

std::vector<std::string> names_of(const std::vector<OptionDescription>& options) {
    std::vector<std::string> names;
    names.reserve(options.size());
    for (const OptionDescription& option : options) names.push_back(option.name);
    return names;
}

void read_fields(const Json& value, const std::vector<OptionDescription>& described, const std::string& prefix,
                 const std::string& owner, MethodOptions& target, Reader& reader);

// Reads through a codec of the contract; keeps the value if there was no fault.
template <class T>
void read_through(const Codec<T>& codec, const Json& value, const std::string& path, MethodOptions& target,
                  Reader& reader) {
    const std::size_t before = reader.count();
    T content{};
    codec.read(value, content, reader);
    if (reader.clean_since(before)) target.set(path, content);
}

void read_plain_number(const Json& value, const OptionDescription& option, const std::string& path,
                       MethodOptions& target, Reader& reader) {
    const auto number = read_number(value, rule_of(option), reader);
    if (!number) return;
    if (option.type == OptionType::integer && *number != static_cast<double>(static_cast<long long>(*number)))
        return reader.fault(reader.name() + " is " + shown(value) + "; it must be a whole number.");
    target.set(path, *number);
}

// Reads one of the words that the option allows.
void read_word(const Json& value, const OptionDescription& option, const std::string& path, MethodOptions& target,
               Reader& reader) {
    std::vector<std::pair<std::string, std::string>> words;
    for (const std::string& word : option.choices) words.emplace_back(word, word);
    read_through(choice(words), value, path, target, reader);
}

void read_number_or_word(const Json& value, const OptionDescription& option, const std::string& path,
                         MethodOptions& target, Reader& reader) {
    NumberRule rule = rule_of(option);
    rule.cure = "The word " + listed(option.choices) + " is possible too.";
    if (value.is_number()) {
        if (const auto number = read_number(value, rule, reader)) target.set(path, *number);
        return;
    }
    const auto is_word = [&](const std::string& word) { return value == word; };
    if (std::any_of(option.choices.begin(), option.choices.end(), is_word))
        return target.set(path, value.get<std::string>());
    const std::string meant = value.is_string() ? nearest(value.get<std::string>(), option.choices) : "";
    reader.fault(wrong_kind(value, "a number or the word " + listed(option.choices), reader) +
                 (meant.empty() ? "" : " Did you mean " + meant + "?"));
}

// Reads two numbers, at the indices 0 and 1.
void read_pair(const Json& value, const OptionDescription& option, const std::string& path, const std::string& wanted,
               MethodOptions& target, Reader& reader) {
    if (!value.is_array() || value.size() != 2) {
        const bool length = value.is_array();
        return reader.fault(length ? reader.name() + " has " + std::to_string(value.size()) + " elements; it must be " +
                                         wanted + "."
                                   : wrong_kind(value, wanted, reader));
    }
    std::optional<double> pair[2];
    for (std::size_t i = 0; i < 2; ++i) {
        const Reader::At at(reader, i);
        pair[i] = read_number(value[i], rule_of(option), reader);
    }
    if (!pair[0] || !pair[1]) return;
    if (option.type != OptionType::complex && !(*pair[0] < *pair[1]))
        return reader.fault(reader.name() + " is " + shown(value) + "; the first number must be below the second.");
    for (std::size_t i = 0; i < 2; ++i) target.set(path + "/" + std::to_string(i), *pair[i]);
}

void read_number_or_pair(const Json& value, const OptionDescription& option, const std::string& path,
                         const std::string& pair, MethodOptions& target, Reader& reader) {
    if (value.is_number()) return read_plain_number(value, option, path, target, reader);
    read_pair(value, option, path, "a number or " + pair, target, reader);
}

void read_list(const Json& value, const OptionDescription& option, const std::string& path, MethodOptions& target,
               Reader& reader) {
    if (!value.is_array()) return reader.fault(wrong_kind(value, "an array", reader));
    if (value.empty() || value.size() > static_cast<std::size_t>(option.max))
        return reader.fault(reader.name() + " has " + std::to_string(value.size()) + " elements; it must have 1 to " +
                            std::to_string(option.max) + ".");
    for (std::size_t i = 0; i < value.size(); ++i) {
        const Reader::At at(reader, i);
        read_option(value[i], option.fields.front(), path + "/" + std::to_string(i), target, reader);
    }
}

bool is_name(const std::string& text) {
    const auto in_name = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
    return !text.empty() && std::isdigit(static_cast<unsigned char>(text[0])) == 0 && text.size() <= kMaxTextLength &&
           std::all_of(text.begin(), text.end(), in_name);
}

void read_numbers_by_name(const Json& value, const OptionDescription& option, const std::string& path,
                          MethodOptions& target, Reader& reader) {
    if (!value.is_object()) return reader.fault(wrong_kind(value, "an object of numbers by name", reader));
    if (value.size() > static_cast<std::size_t>(option.max))
        return reader.fault(reader.name() + " has " + std::to_string(value.size()) + " names; it must have at most " +
                            std::to_string(option.max) + ".");
    const std::string below = path + "/";
    for (const auto& [name, member] : value.items()) {
        if (!is_name(name)) {
            reader.fault_at(
                name, shown(Json(name)) +
                          " is not a valid name; a name has letters, digits and _, and does not begin with a digit.");
            continue;
        }
        const Reader::At at(reader, name);
        if (const auto number = read_number(member, rule_of(option), reader)) target.set(below + name, *number);
    }
}

void read_object(const Json& value, const OptionDescription& option, const std::string& path, MethodOptions& target,
                 Reader& reader) {
    if (!value.is_object())
        return reader.fault(wrong_kind(value, "an object with " + listed(names_of(option.fields)), reader));
    if (option.at_most_fields > 0 && value.size() > static_cast<std::size_t>(option.at_most_fields))
        return reader.fault(reader.name() + " has " + std::to_string(value.size()) + " fields; it must have at most " +
                            std::to_string(option.at_most_fields) + " of " + listed(names_of(option.fields)) + ".");
    for (const OptionDescription& field : option.fields)
        if (field.required && !value.contains(field.name)) reader.fault_at(field.name, field.name + " is missing.");
    read_fields(value, option.fields, path + "/", reader.name(), target, reader);
}

void read_fields(const Json& value, const std::vector<OptionDescription>& described, const std::string& prefix,
                 const std::string& owner, MethodOptions& target, Reader& reader) {
    for (const auto& [name, member] : value.items()) {
        if (prefix.empty() && name == "method") continue;
        const auto option = std::find_if(described.begin(), described.end(),
                                         [&given = name](const OptionDescription& o) { return o.name == given; });
        if (option != described.end()) {
            const Reader::At at(reader, name);
            read_option(member, *option, prefix + name, target, reader);
            continue;
        }
        reader.fault_at(name, unknown_option(name, owner, names_of(described)));
    }
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

Json pair_schema(const OptionDescription& option) {
    return {{"type", "array"}, {"items", number_schema(rule_of(option))}, {"minItems", 2}, {"maxItems", 2}};
}

Json object_schema(const OptionDescription& option) {
    Json schema = options_schema(option.fields);
    if (option.at_most_fields > 0) schema["maxProperties"] = option.at_most_fields;
    for (const OptionDescription& field : option.fields)
        if (field.required) schema["required"].push_back(field.name);
    return schema;
}

Json option_schema(const OptionDescription& option);

Json bare_schema(const OptionDescription& option) {
    Json plain = number_schema(rule_of(option));
    switch (option.type) {
        case OptionType::number: return plain;
        case OptionType::integer: {
            Json whole = plain;
            whole["type"] = "integer";
            return whole;
        }
        case OptionType::boolean: return {{"type", "boolean"}};
        case OptionType::choice: return {{"type", "string"}, {"enum", option.choices}};
        case OptionType::text: return {{"type", "string"}, {"maxLength", kMaxTextLength}};
        case OptionType::number_or_word:
            return {{"oneOf", Json::array({plain, Json{{"type", "string"}, {"enum", option.choices}}})}};
        case OptionType::range: return pair_schema(option);
        case OptionType::number_or_range:
        case OptionType::complex: return {{"oneOf", Json::array({plain, pair_schema(option)})}};
        case OptionType::object: return object_schema(option);
        case OptionType::numbers_by_name:
            return {{"type", "object"}, {"additionalProperties", plain}, {"maxProperties", option.max}};
        case OptionType::list:
            return {{"type", "array"},
                    {"items", option_schema(option.fields.front())},
                    {"minItems", 1},
                    {"maxItems", option.max}};
    }
    return Json::object();
}

Json option_schema(const OptionDescription& option) {
    Json schema = bare_schema(option);
    if (!option.sentence.empty()) schema["description"] = option.sentence;
    if (!option.unit.empty()) schema["x-unit"] = option.unit;
    if (option.default_value) schema["default"] = to_json(*option.default_value);
    if (option.main) schema["x-main"] = true;
    if (!option.in_place_of.empty()) schema["x-in-place-of"] = option.in_place_of;
    if (option.draws) schema["x-draws"] = true;
    if (option.slider) schema["x-slider"] = to_json(*option.slider);
    return schema;
}

bool is_index(const std::string& name) { return std::all_of(name.begin(), name.end(), ::isdigit); }

}  // namespace

std::string unknown_option(const std::string& name, const std::string& owner, const std::vector<std::string>& names) {
    const std::string meant = nearest(name, names);
    return name + " is not an option of " + owner + "; " +
           (!meant.empty()  ? "did you mean " + meant + "?"
            : names.empty() ? "it has none."
                            : "its options are " + listed(names, "and") + ".");
}

void read_option(const Json& value, const OptionDescription& option, const std::string& path, MethodOptions& target,
                 Reader& reader) {
    switch (option.type) {
        case OptionType::number:
        case OptionType::integer: return read_plain_number(value, option, path, target, reader);
        case OptionType::boolean: return read_through(boolean(), value, path, target, reader);
        case OptionType::choice: return read_word(value, option, path, target, reader);
        case OptionType::text: return read_through(text(kMaxTextLength), value, path, target, reader);
        case OptionType::number_or_word: return read_number_or_word(value, option, path, target, reader);
        case OptionType::range: return read_pair(value, option, path, "[low, high]", target, reader);
        case OptionType::number_or_range:
            return read_number_or_pair(value, option, path, "[low, high]", target, reader);
        case OptionType::complex: return read_number_or_pair(value, option, path, "[re, im]", target, reader);
        case OptionType::list: return read_list(value, option, path, target, reader);
        case OptionType::numbers_by_name: return read_numbers_by_name(value, option, path, target, reader);
        case OptionType::object: return read_object(value, option, path, target, reader);
    }
}

void read_options(const Json& value, const std::vector<OptionDescription>& described, const std::string& owner,
                  MethodOptions& target, Reader& reader) {
    read_fields(value, described, "", owner, target, reader);
}

void place_option(Json& object, const std::string& path, const OptionValue& value) {
    const std::size_t slash = path.find('/');
    const std::string name = path.substr(0, slash);
    Json* at = nullptr;
    if (is_index(name)) {
        if (!object.is_array()) object = Json::array();
        const std::size_t index = std::stoul(name);
        while (object.size() <= index) object.push_back(nullptr);
        at = &object[index];
    } else {
        if (!object.is_object()) object = Json::object();
        at = &object[name];
    }
    if (slash == std::string::npos)
        *at = to_json(value);
    else
        place_option(*at, path.substr(slash + 1), value);
}

Json options_schema(const std::vector<OptionDescription>& options) {
    Json properties = Json::object();
    for (const OptionDescription& option : options) properties[option.name] = option_schema(option);
    return {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
}

}  // namespace tunewright::api
