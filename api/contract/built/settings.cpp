#include "api/contract/built/settings.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMostSettings = 40;

void read_setting(const std::string& name, const Json& value, product::Settings& settings, Reader& reader) {
    const Reader::At at(reader, name);
    if (value.is_boolean()) {
        settings.push_back({name, value.get<bool>()});
    } else if (value.is_string()) {
        settings.push_back({name, value.get<std::string>()});
    } else if (const auto number = read_number(value, {}, reader)) {
        settings.push_back({name, *number});
    }
}

}  // namespace

Codec<product::Settings> settings_codec() {
    Codec<product::Settings> codec;
    codec.read = [](const Json& value, product::Settings& settings, Reader& reader) {
        if (!value.is_object()) return reader.fault(wrong_kind(value, "an object such as {\"Kp\": 1.5}", reader));
        if (value.size() > kMostSettings)
            return reader.fault("settings has " + std::to_string(value.size()) + " members; no product has so many.");
        settings.clear();
        for (const auto& [name, member] : value.items()) read_setting(name, member, settings, reader);
    };
    codec.write = [](const product::Settings& settings, Writer& out) {
        out.begin_object();
        for (const product::Setting& setting : settings) {
            out.key(setting.name);
            if (const auto* number = std::get_if<double>(&setting.value))
                out.number(*number);
            else if (const auto* on = std::get_if<bool>(&setting.value))
                out.boolean(*on);
            else
                out.text(std::get<std::string>(setting.value));
        }
        out.end_object();
    };
    codec.schema = [](SchemaBook&) {
        return Json{{"type", "object"}, {"additionalProperties", {{"type", {"number", "string", "boolean"}}}}};
    };
    return codec;
}

}  // namespace tunewright::api
