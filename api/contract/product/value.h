// Values and settings of products as JSON: a number, a word or a switch by its parameter's name.
#pragma once

#include "api/json/json.h"
#include "api/json/writer.h"
#include "engine/controller/product/settings.h"

namespace tunewright::api {

inline void write_value(const product::Value& value, Writer& out) {
    if (const double* number = std::get_if<double>(&value)) return out.number(*number);
    if (const bool* flag = std::get_if<bool>(&value)) return out.boolean(*flag);
    out.text(std::get<std::string>(value));
}

inline void write_settings(const product::Settings& settings, Writer& out) {
    out.begin_object();
    for (const product::Setting& setting : settings) {
        out.key(setting.name);
        write_value(setting.value, out);
    }
    out.end_object();
}

inline Json value_schema() { return {{"type", {"number", "string", "boolean"}}}; }

inline Json settings_schema() {
    return {{"type", "object"},
            {"propertyNames", {{"description", "Names of the product's parameters."}}},
            {"additionalProperties", value_schema()}};
}

}  // namespace tunewright::api
