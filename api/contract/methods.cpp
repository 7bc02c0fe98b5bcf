#include "api/contract/methods.h"

#include <algorithm>

#include "api/contract/method_options.h"
#include "engine/tuning/registry.h"

namespace tunewright::api {
namespace {

constexpr const char* kAll = "all";

std::vector<std::string> method_ids() {
    std::vector<std::string> ids;
    for (const TuningMethod& method : method_registry()) ids.push_back(method.id);
    return ids;
}

std::vector<std::string> names_of_all() {
    std::vector<std::string> names;
    for (const TuningMethod& method : method_registry())
        if (method.compared)
            for (const OptionDescription& option : method.options) names.push_back(option.name);
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    return names;
}

// The description of an option by the first method that accepts this value for it; null if none does. `named` becomes
// true if a method has the option.
const OptionDescription* taking(const std::string& name, const Json& value, const Reader& reader,
                                const OptionDescription*& named) {
    for (const TuningMethod& method : method_registry()) {
        if (!method.compared) continue;
        for (const OptionDescription& option : method.options) {
            if (option.name != name) continue;
            if (named == nullptr) named = &option;
            Reader trial = reader;
            MethodOptions ignored;
            option_codec(option).read(value, ignored, trial);
            if (trial.clean_since(reader.count())) return &option;
        }
    }
    return nullptr;
}

// With "all", each method takes the options that it has. A value must suit one of them; the other methods then report
// why it does not suit them.
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
        option_codec(suits ? *suits : *named).read(member, target, reader);
    }
}

void read_method(const Json& value, MethodRequest& target, Reader& reader) {
    if (!value.is_object()) return reader.fault(wrong_kind(value, R"(an object such as {"method": "robust"})", reader));
    auto ids = method_ids();
    ids.emplace_back(kAll);
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
    read_options(value, method->options, method->id, target.options, reader);
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
            if (!method.compared) break;
            Json any = option;
            for (const char* of_one_form : {"default", "x-main", "x-draws", "x-slider", "x-in-place-of"})
                any.erase(of_one_form);
            Json& known = of_all[name]["anyOf"];
            if (std::find(known.begin(), known.end(), any) == known.end()) known.push_back(std::move(any));
        }
        add(method.id, method_schema(method.id, method.title, method.formula + " Source: " + method.source, options));
    }
    // A choice with one alternative is written as this alternative, because generators of clients fail on such a
    // choice.
    for (auto& [name, option] : of_all.items())
        if (option["anyOf"].size() == 1) option = Json(option["anyOf"][0]);
    add(kAll, method_schema(kAll, "Every method",
                            "Every method in all its variants, each with those of the options that it has. A method "
                            "that does not apply is an entry with the reason.",
                            of_all));
    book.components["Method"] = {
        {"title", "Method"}, {"description", "A tuning method with its options."}, {"oneOf", std::move(choices)}};
    return {{"$ref", "#/components/schemas/Method"}};
}

}  // namespace

Codec<MethodRequest> method_request() {
    return {read_method,
            [](const MethodRequest& request, Writer& out) {
                Json object{{"method", request.method}};
                for (const auto& [path, value] : request.options.values()) place_option(object, path, value);
                out.raw(object.dump());
            },
            methods_schema};
}

Codec<std::vector<MethodRequest>> tune_list() {
    auto codec = list_of(method_request(), 0, kMaxMethods);
    codec.read = [list = codec.read](const Json& value, std::vector<MethodRequest>& target, Reader& reader) {
        if (value == kAll) {
            target = {{kAll, {}}};
        } else if (value.is_array()) {
            list(value, target, reader);
        } else {
            reader.fault(wrong_kind(value, R"(an array of methods such as [{"method": "robust"}], or "all")", reader));
        }
    };
    codec.schema = [list = codec.schema](SchemaBook& book) {
        return Json{{"oneOf", Json::array({list(book), Json{{"type", "string"}, {"const", kAll}}})}};
    };
    return codec;
}

void write_options(const std::string& method, const MethodOptions& options, Writer& out) {
    Json object = Json::object();
    const auto& all = options.values();
    if (const TuningMethod* described = find_method(method)) {
        for (const OptionDescription& option : described->options)
            if (option.default_value && options.has(option.name))
                place_option(object, option.name, all.at(option.name));
    }
    for (const auto& [path, value] : all) place_option(object, path, value);
    out.raw(object.dump());
}

}  // namespace tunewright::api
