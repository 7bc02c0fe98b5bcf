#include "api/contract/product/product.h"

#include "api/csv/time_stamp.h"

namespace tunewright::api {
namespace {

constexpr std::size_t kMostSettings = 40;
constexpr std::size_t kMaxWord = 200;

void read_setting(const std::string& name, const Json& value, product::Settings& settings, Reader& reader) {
    const Reader::At at(reader, name);
    if (value.is_number()) {
        if (const auto number = read_number(value, {}, reader)) settings.push_back({name, *number});
    } else if (value.is_boolean()) {
        settings.push_back({name, value.get<bool>()});
    } else if (value.is_string() && value.get_ref<const std::string&>().size() <= kMaxWord) {
        settings.push_back({name, value.get<std::string>()});
    } else {
        reader.fault(wrong_kind(value, "a number, a short string, true or false", reader));
    }
}

}  // namespace

void write_value(const product::Value& value, Writer& out) {
    if (const double* number = std::get_if<double>(&value)) return out.number(*number);
    if (const bool* flag = std::get_if<bool>(&value)) return out.boolean(*flag);
    out.text(std::get<std::string>(value));
}

Json value_schema() { return {{"type", {"number", "string", "boolean"}}}; }

Codec<product::Settings> settings_codec() {
    Codec<product::Settings> codec;
    codec.read = [](const Json& value, product::Settings& settings, Reader& reader) {
        if (!value.is_object()) return reader.fault(wrong_kind(value, "an object such as {\"Gain\": 1.5}", reader));
        if (value.size() > kMostSettings)
            return reader.fault("settings has " + std::to_string(value.size()) + " members; no product has so many.");
        settings.clear();
        for (const auto& [name, member] : value.items()) read_setting(name, member, settings, reader);
    };
    codec.write = [](const product::Settings& settings, Writer& out) {
        out.begin_object();
        for (const product::Setting& setting : settings) {
            out.key(setting.name);
            write_value(setting.value, out);
        }
        out.end_object();
    };
    codec.schema = [](SchemaBook&) {
        return Json{{"type", "object"},
                    {"propertyNames", {{"description", "Names of the product's parameters."}}},
                    {"additionalProperties", value_schema()}};
    };
    return codec;
}

void check_span(const char* name, const std::optional<std::vector<double>>& given, Reader& reader) {
    if (given && !((*given)[0] < (*given)[1]))
        reader.fault_at(name, std::string(name) + " is [" + full_digits((*given)[0]) + ", " + full_digits((*given)[1]) +
                                  "]; its first number must be below the second.");
}

product::Context context_of(const std::optional<std::vector<double>>& y_span,
                            const std::optional<std::vector<double>>& u_span, double seconds_per_time) {
    product::Context context;
    context.seconds_per_time = seconds_per_time;
    context.y_span_given = y_span.has_value();
    context.u_span_given = u_span.has_value();
    product::Spans& spans = context.spans;
    if (y_span) spans.y_low = (*y_span)[0], spans.y_high = (*y_span)[1];
    if (u_span) spans.u_low = (*u_span)[0], spans.u_high = (*u_span)[1];
    return context;
}

std::optional<double> seconds_per_time(const std::string& label, Reader& reader) {
    const auto seconds = seconds_per(label);
    if (seconds) return seconds;
    const Reader::At at(reader, "units");
    reader.fault_at("time", "units.time is " + shown(label) +
                                ", which is no unit of time that is known; the product's times are in its own. Use s, "
                                "min, h or another.");
    return std::nullopt;
}

}  // namespace tunewright::api
