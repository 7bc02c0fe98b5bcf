#include "api/contract/methods.h"

#include <algorithm>

namespace tunewright::api {
namespace {

NumberRule rule_of(const OptionDescription& option) {
    return {.minimum = option.minimum, .exclusive_minimum = option.exclusive_minimum, .maximum = option.maximum};
}

std::vector<std::string> names_of(const std::vector<OptionDescription>& options) {
    std::vector<std::string> names;
    for (const OptionDescription& option : options) names.push_back(option.name);
    return names;
}

void read_options(const Json& value, const std::vector<OptionDescription>& described, const std::string& prefix,
                  const std::string& owner, MethodOptions& target, Reader& reader);

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
        case OptionType::choice: {
            std::vector<std::pair<std::string, std::string>> words;
            for (const std::string& word : option.choices) words.emplace_back(word, word);
            const std::size_t before = reader.count();
            std::string content;
            choice(words).read(value, content, reader);
            if (reader.clean_since(before)) target.set(path, content);
            return;
        }
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
        const auto names = names_of(described);
        const std::string meant = nearest(name, names);
        reader.fault_at(name, name + " is not an option of " + owner + "; " +
                                  (!meant.empty()  ? "did you mean " + meant + "?"
                                   : names.empty() ? "it has none."
                                                   : "its options are " + listed(names, "and") + "."));
    }
}

std::vector<std::string> method_ids() {
    std::vector<std::string> ids;
    for (const TuningMethod& method : method_registry()) ids.push_back(method.id);
    return ids;
}

void read_method(const Json& value, MethodRequest& target, Reader& reader) {
    if (!value.is_object())
        return reader.fault(wrong_kind(value, "an object such as {\"method\": \"robust\"}", reader));
    const auto word = value.find("method");
    if (word == value.end())
        return reader.fault_at("method", "method is missing; it must be " + listed(method_ids()) + ".");
    const TuningMethod* method = word->is_string() ? find_method(word->get<std::string>()) : nullptr;
    if (!method) {
        const auto ids = method_ids();
        const std::string meant = word->is_string() ? nearest(word->get<std::string>(), ids) : "";
        return reader.fault_at("method", "method is " + shown(*word) + "; it must be " + listed(ids) + "." +
                                             (meant.empty() ? "" : " Did you mean " + meant + "?"));
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
            [](SchemaBook& book) {
                Json choices = Json::array();
                for (const TuningMethod& method : method_registry()) {
                    const std::string name = "Method_" + method.id;
                    Json schema = options_schema(method.options);
                    Json properties{{"method", {{"type", "string"}, {"const", method.id}}}};
                    for (const auto& [option, content] : schema["properties"].items()) properties[option] = content;
                    book.components[name] = {{"type", "object"},
                                             {"title", method.title},
                                             {"description", method.formula + " Source: " + method.source},
                                             {"properties", std::move(properties)},
                                             {"required", {"method"}},
                                             {"additionalProperties", false}};
                    choices.push_back({{"$ref", "#/components/schemas/" + name}});
                }
                book.components["Method"] = {{"title", "Method"},
                                             {"description", "A tuning method with its options."},
                                             {"oneOf", std::move(choices)}};
                return Json{{"$ref", "#/components/schemas/Method"}};
            }};
}

Codec<std::vector<MethodRequest>> tune_list() {
    constexpr std::size_t kMost = 50;
    auto codec = list_of(method_request(), 1, kMost);
    codec.read = [list = codec.read](const Json& value, std::vector<MethodRequest>& target, Reader& reader) {
        if (value == "all") {
            target.clear();
            for (const std::string& id : method_ids()) target.push_back({id, {}});
        } else if (value.is_array()) {
            list(value, target, reader);
        } else {
            reader.fault(
                wrong_kind(value, "an array of methods such as [{\"method\": \"robust\"}], or \"all\"", reader));
        }
    };
    codec.schema = [list = codec.schema](SchemaBook& book) {
        return Json{{"oneOf", Json::array({list(book), Json{{"type", "string"}, {"const", "all"}}})}};
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
