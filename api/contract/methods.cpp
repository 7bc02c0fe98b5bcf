#include "api/contract/methods.h"

#include <algorithm>

namespace tunewright::api {
namespace {

constexpr const char* kAll = "all";

NumberRule rule_of(const OptionDescription& option) {
    return {.minimum = option.minimum, .exclusive_minimum = option.exclusive_minimum, .maximum = option.maximum};
}

std::vector<std::string> names_of(const std::vector<OptionDescription>& options) {
    std::vector<std::string> names;
    for (const OptionDescription& option : options) names.push_back(option.name);
    return names;
}

std::string unknown_option(const std::string& name, const std::string& owner, const std::vector<std::string>& names) {
    const std::string meant = nearest(name, names);
    return name + " is not an option of " + owner + "; " +
           (!meant.empty()  ? "did you mean " + meant + "?"
            : names.empty() ? "it has none."
                            : "its options are " + listed(names, "and") + ".");
}

void read_options(const Json& value, const std::vector<OptionDescription>& described, const std::string& prefix,
                  const std::string& owner, MethodOptions& target, Reader& reader);

// A word from the option's list.
void read_word(const Json& value, const OptionDescription& option, const std::string& path, MethodOptions& target,
               Reader& reader) {
    std::vector<std::pair<std::string, std::string>> words;
    for (const std::string& word : option.choices) words.emplace_back(word, word);
    const std::size_t before = reader.count();
    std::string content;
    choice(words).read(value, content, reader);
    if (reader.clean_since(before)) target.set(path, content);
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

void read_option(const Json& value, const OptionDescription& option, const std::string& path, MethodOptions& target,
                 Reader& reader) {
    switch (option.type) {
        case OptionType::number:
            if (const auto number = read_number(value, rule_of(option), reader)) target.set(path, *number);
            return;
        case OptionType::integer: {
            const auto number = read_number(value, rule_of(option), reader);
            if (!number) return;
            if (*number != static_cast<double>(static_cast<long long>(*number)))
                return reader.fault(reader.name() + " is " + shown(value) + "; it must be a whole number.");
            target.set(path, *number);
            return;
        }
        case OptionType::boolean: {
            const std::size_t before = reader.count();
            bool content = false;
            boolean().read(value, content, reader);
            if (reader.clean_since(before)) target.set(path, content);
            return;
        }
        case OptionType::choice: return read_word(value, option, path, target, reader);
        case OptionType::number_or_word: return read_number_or_word(value, option, path, target, reader);
        case OptionType::object:
            if (!value.is_object())
                return reader.fault(wrong_kind(value, "an object with " + listed(names_of(option.fields)), reader));
            if (option.at_most_fields > 0 && value.size() > static_cast<std::size_t>(option.at_most_fields)) {
                return reader.fault(reader.name() + " has " + std::to_string(value.size()) +
                                    " fields; it must have at most " + std::to_string(option.at_most_fields) + " of " +
                                    listed(names_of(option.fields)) + ".");
            }
            read_options(value, option.fields, path + "/", reader.name(), target, reader);
    }
}

void read_options(const Json& value, const std::vector<OptionDescription>& described, const std::string& prefix,
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

std::vector<std::string> method_ids() {
    std::vector<std::string> ids;
    for (const TuningMethod& method : method_registry()) ids.push_back(method.id);
    return ids;
}

std::vector<std::string> names_of_all() {
    std::vector<std::string> names;
    for (const TuningMethod& method : method_registry())
        for (const OptionDescription& option : method.options) names.push_back(option.name);
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

// The description of an option by the first method that takes this value for it; null if none does, but `named` if one
// knows the option.
const OptionDescription* taking(const std::string& name, const Json& value, const Reader& reader,
                                const OptionDescription*& named) {
    for (const TuningMethod& method : method_registry()) {
        for (const OptionDescription& option : method.options) {
            if (option.name != name) continue;
            if (named == nullptr) named = &option;
            Reader trial = reader;
            MethodOptions ignored;
            read_option(value, option, name, ignored, trial);
            if (trial.clean_since(reader.count())) return &option;
        }
    }
    return nullptr;
}

// Of "all", each method takes the options that it knows. A value must suit one of them; the others will say why it does
// not suit them.
void read_options_of_all(const Json& value, MethodOptions& target, Reader& reader) {
    for (const auto& [name, member] : value.items()) {
        if (name == "method") continue;
        const Reader::At at(reader, name);
        const OptionDescription* named = nullptr;
        const OptionDescription* suits = taking(name, member, reader, named);
        if (named == nullptr) {
            reader.fault(unknown_option(name, "any method", names_of_all()));
            continue;
        }
        read_option(member, suits ? *suits : *named, name, target, reader);
    }
}

void read_method(const Json& value, MethodRequest& target, Reader& reader) {
    if (!value.is_object())
        return reader.fault(wrong_kind(value, "an object such as {\"method\": \"robust\"}", reader));
    auto ids = method_ids();
    ids.push_back(kAll);
    const auto word = value.find("method");
    if (word == value.end()) return reader.fault_at("method", "method is missing; it must be " + listed(ids) + ".");
    if (*word == kAll) {
        target.method = kAll;
        return read_options_of_all(value, target.options, reader);
    }
    const TuningMethod* method = word->is_string() ? find_method(word->get<std::string>()) : nullptr;
    if (!method) {
        const std::string meant = word->is_string() ? nearest(word->get<std::string>(), ids) : "";
        const std::string known =
            meant.empty() ? "it must be " + listed(ids) + "." : "there is no such method. Did you mean " + meant + "?";
        return reader.fault_at("method", "method is " + shown(*word) + "; " + known);
    }
    target.method = method->id;
    read_options(value, method->options, "", method->id, target.options, reader);
}

Json to_json(const OptionValue& value) {
    return std::visit([](const auto& content) { return Json(content); }, value);
}

Json option_schema(const OptionDescription& option) {
    Json schema;
    switch (option.type) {
        case OptionType::number: schema = number_schema(rule_of(option)); break;
        case OptionType::integer:
            schema = number_schema(rule_of(option));
            schema["type"] = "integer";
            break;
        case OptionType::boolean: schema = {{"type", "boolean"}}; break;
        case OptionType::choice: schema = {{"type", "string"}, {"enum", option.choices}}; break;
        case OptionType::number_or_word:
            schema = {{"oneOf", Json::array({number_schema(rule_of(option)),
                                             Json{{"type", "string"}, {"enum", option.choices}}})}};
            break;
        case OptionType::object:
            schema = options_schema(option.fields);
            if (option.at_most_fields > 0) schema["maxProperties"] = option.at_most_fields;
            break;
    }
    schema["description"] = option.sentence;
    if (!option.unit.empty()) schema["x-unit"] = option.unit;
    if (option.default_value) schema["default"] = to_json(*option.default_value);
    return schema;
}

Json method_schema(const std::string& id, const std::string& title, const std::string& sentence, const Json& options) {
    Json properties{{"method", {{"type", "string"}, {"const", id}}}};
    for (const auto& [name, option] : options.items()) properties[name] = option;
    return {{"type", "object"},         {"title", title},         {"description", sentence},
            {"properties", properties}, {"required", {"method"}}, {"additionalProperties", false}};
}

Json methods_schema(SchemaBook& book) {
    Json choices = Json::array(), of_all = Json::object();
    const auto add = [&](const std::string& id, Json schema) {
        book.components["Method_" + id] = std::move(schema);
        choices.push_back({{"$ref", "#/components/schemas/Method_" + id}});
    };
    for (const TuningMethod& method : method_registry()) {
        const Json options = options_schema(method.options)["properties"];
        for (const auto& [name, option] : options.items()) {
            Json any = option;
            any.erase("default");
            Json& known = of_all[name]["anyOf"];
            if (std::find(known.begin(), known.end(), any) == known.end()) known.push_back(std::move(any));
        }
        add(method.id, method_schema(method.id, method.title, method.formula + " Source: " + method.source, options));
    }
    add(kAll,
        method_schema(kAll, "Every method",
                      "Every method in all its variants, each with those options that it knows. One that does not "
                      "apply is an entry with its reason.",
                      of_all));
    book.components["Method"] = {
        {"title", "Method"}, {"description", "A tuning method with its options."}, {"oneOf", std::move(choices)}};
    return {{"$ref", "#/components/schemas/Method"}};
}

// "reduction/method": "auto" -> {"reduction": {"method": "auto"}}
void put(Json& object, const std::string& path, const OptionValue& value) {
    const std::size_t slash = path.find('/');
    if (slash == std::string::npos) {
        object[path] = to_json(value);
    } else {
        put(object[path.substr(0, slash)], path.substr(slash + 1), value);
    }
}

}  // namespace

Json options_schema(const std::vector<OptionDescription>& options) {
    Json properties = Json::object();
    for (const OptionDescription& option : options) properties[option.name] = option_schema(option);
    return {{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
}

Codec<MethodRequest> method_request() {
    return {read_method,
            [](const MethodRequest& request, Writer& out) {
                Json object{{"method", request.method}};
                for (const auto& [path, value] : request.options.values()) put(object, path, value);
                out.raw(object.dump());
            },
            methods_schema};
}

Codec<std::vector<MethodRequest>> tune_list() {
    constexpr std::size_t kMost = 50;
    auto codec = list_of(method_request(), 1, kMost);
    codec.read = [list = codec.read](const Json& value, std::vector<MethodRequest>& target, Reader& reader) {
        if (value == kAll) {
            target = {{kAll, {}}};
        } else if (value.is_array()) {
            list(value, target, reader);
        } else {
            reader.fault(
                wrong_kind(value, "an array of methods such as [{\"method\": \"robust\"}], or \"all\"", reader));
        }
    };
    codec.schema = [list = codec.schema](SchemaBook& book) {
        return Json{{"oneOf", Json::array({list(book), Json{{"type", "string"}, {"const", kAll}}})}};
    };
    return codec;
}

void write_options(const std::string& method, const MethodOptions& options, Writer& out) {
    Json object = Json::object();
    if (const TuningMethod* described = find_method(method)) {
        for (const OptionDescription& option : described->options) {
            if (option.default_value) object[option.name] = to_json(*option.default_value);
        }
    }
    for (const auto& [path, value] : options.values()) put(object, path, value);
    out.raw(object.dump());
}

}  // namespace tunewright::api
