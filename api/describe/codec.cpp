#include "api/describe/codec.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace tunewright::api {
namespace {

// The cure for a number in quotes or for a word that means "no number".
std::string cure_for(const Json& value) {
    if (!value.is_string()) return {};
    const auto& content = value.get_ref<const std::string&>();
    double number = 0;
    const auto [end, error] = std::from_chars(content.data(), content.data() + content.size(), number);
    if (error == std::errc() && end == content.data() + content.size() && std::isfinite(number)) {
        return " Write " + content + " without quotes.";
    }
    std::string lower;
    for (const char c : content) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (lower.find("nan") != lower.npos || lower.find("inf") != lower.npos) {
        return " NaN and Infinity are not accepted: give a finite number or leave the field out.";
    }
    if (content.find(',') != content.npos) return " The decimal sign in JSON is the point.";
    return {};
}

// Keeps quotients finite and every time or frequency within reach.
constexpr double kSmallestNumber = 1e-30;

std::string broken_rule(double value, const NumberRule& rule) {
    if (std::abs(value) > kLargestNumber) return "at most 1e30 in size";
    if (value != 0 && std::abs(value) < kSmallestNumber) return "0 or at least 1e-30 in size; choose another unit";
    if (!rule.between(value)) {
        std::string text;
        if (rule.minimum) text = ">= " + full_digits(*rule.minimum);
        if (rule.exclusive_minimum) text = "> " + full_digits(*rule.exclusive_minimum);
        if (!text.empty() && (rule.maximum || rule.exclusive_maximum)) text += " and ";
        if (rule.maximum) text += "<= " + full_digits(*rule.maximum);
        if (rule.exclusive_maximum) text += "< " + full_digits(*rule.exclusive_maximum);
        return text;
    }
    if (rule.not_zero && value == 0) return "different from 0";
    return {};
}

}  // namespace

std::string wrong_kind(const Json& value, const std::string& wanted, const Reader& reader) {
    const std::string what = value.is_null()         ? "null"
                             : value.is_structured() ? kind_of(value)
                                                     : shown(value) + ", " + kind_of(value);
    return reader.name() + " is " + what + "; it must be " + wanted + "." + cure_for(value);
}

std::optional<double> read_number(const Json& value, const NumberRule& rule, Reader& reader) {
    if (!value.is_number()) {
        reader.fault(wrong_kind(value, "a number", reader));
        return std::nullopt;
    }
    const double number = value.get<double>();
    if (const std::string broken = broken_rule(number, rule); !broken.empty()) {
        reader.fault(reader.name() + " is " + full_digits(number) + "; it must be " + broken + "." +
                     (rule.cure.empty() ? "" : " " + rule.cure));
        return std::nullopt;
    }
    return number;
}

Json number_schema(const NumberRule& rule) {
    Json out{{"type", "number"}};
    if (rule.minimum) out["minimum"] = *rule.minimum;
    if (rule.exclusive_minimum) out["exclusiveMinimum"] = *rule.exclusive_minimum;
    if (rule.maximum) out["maximum"] = *rule.maximum;
    if (rule.exclusive_maximum) out["exclusiveMaximum"] = *rule.exclusive_maximum;
    if (rule.not_zero) out["not"] = Json{{"const", 0}};
    return out;
}

Codec<double> number(const NumberRule& rule) {
    return {[rule](const Json& value, double& target, Reader& reader) {
                if (const auto read = read_number(value, rule, reader)) target = *read;
            },
            [](const double& value, Writer& out) { out.number(value); },
            [rule](SchemaBook&) { return number_schema(rule); }};
}

Codec<double> engine_ruled(const NumberRule& rule) {
    Codec<double> codec = number();
    codec.schema = number(rule).schema;
    return codec;
}

Codec<int> integer(const NumberRule& rule) {
    return {[rule](const Json& value, int& target, Reader& reader) {
                const auto read = read_number(value, rule, reader);
                if (!read) return;
                if (*read != std::trunc(*read))
                    return reader.fault(reader.name() + " is " + shown(value) + "; it must be a whole number.");
                target = static_cast<int>(*read);
            },
            [](const int& value, Writer& out) { out.integer(value); },
            [rule](SchemaBook&) {
                Json out = number_schema(rule);
                out["type"] = "integer";
                return out;
            }};
}

Codec<bool> boolean() {
    return {[](const Json& value, bool& target, Reader& reader) {
                if (!value.is_boolean()) return reader.fault(wrong_kind(value, "true or false", reader));
                target = value.get<bool>();
            },
            [](const bool& value, Writer& out) { out.boolean(value); },
            [](SchemaBook&) {
                return Json{{"type", "boolean"}};
            }};
}

Codec<std::string> text(std::size_t longest) {
    return {[longest](const Json& value, std::string& target, Reader& reader) {
                if (!value.is_string()) return reader.fault(wrong_kind(value, "a string", reader));
                const auto& content = value.get_ref<const std::string&>();
                if (content.size() > longest) {
                    return reader.fault(reader.name() + " has " + std::to_string(content.size()) +
                                        " bytes; it must have at most " + std::to_string(longest) + ".");
                }
                target = content;
            },
            [](const std::string& value, Writer& out) { out.text(value); },
            [longest](SchemaBook&) {
                return Json{{"type", "string"}, {"maxLength", longest}};
            }};
}

Codec<std::string> words() {
    return {{},
            [](const std::string& value, Writer& out) { out.text(value); },
            [](SchemaBook&) {
                return Json{{"type", "string"}};
            }};
}

Codec<double> number_or_infinite(const NumberRule& rule, const std::string& meaning_of_null) {
    return {[rule](const Json& value, double& target, Reader& reader) {
                if (value.is_null()) {
                    target = std::numeric_limits<double>::infinity();
                } else if (const auto read = read_number(value, rule, reader)) {
                    target = *read;
                }
            },
            [](const double& value, Writer& out) { out.number(value); },
            [rule, meaning_of_null](SchemaBook&) {
                Json out = number_schema(rule);
                out["type"] = {"number", "null"};
                out["x-null"] = meaning_of_null;
                return out;
            }};
}

Codec<std::vector<double>> numbers(std::size_t min, std::size_t max, const NumberRule& rule) {
    constexpr std::size_t kFaultsListed = 5;
    return {[min, max, rule](const Json& value, std::vector<double>& target, Reader& reader) {
                if (!value.is_array()) return reader.fault(wrong_kind(value, "an array of numbers", reader));
                if (value.size() < min || value.size() > max) {
                    return reader.fault(reader.name() + " has " + std::to_string(value.size()) +
                                        " numbers; it must have " + std::to_string(min) + " to " + std::to_string(max) +
                                        "." + (rule.cure.empty() ? "" : " " + rule.cure));
                }
                target.assign(value.size(), 0);
                const std::size_t before = reader.count();
                for (std::size_t i = 0; i < value.size() && reader.count() < before + kFaultsListed; ++i) {
                    const Json& element = value[i];
                    if (element.is_number()) {
                        const double read = element.get<double>();
                        // Among numbers of a matrix or a record, one that small is a rounding error of 0.
                        if (std::abs(read) < kSmallestNumber && !rule.exclusive_minimum) continue;
                        if (broken_rule(read, rule).empty()) {
                            target[i] = read;
                            continue;
                        }
                    }
                    const Reader::At at(reader, i);
                    read_number(element, rule, reader);
                }
            },
            [](const std::vector<double>& values, Writer& out) {
                out.begin_array();
                for (const double value : values) out.number(value);
                out.end_array();
            },
            [min, max, rule](SchemaBook&) {
                return Json{{"type", "array"}, {"items", number_schema(rule)}, {"minItems", min}, {"maxItems", max}};
            }};
}

Codec<std::vector<double>> trace() {
    return {{},
            [](const std::vector<double>& values, Writer& out) { out.trace(values); },
            [](SchemaBook&) {
                return Json{{"type", "array"}, {"items", {{"type", {"number", "null"}}}}};
            }};
}

Codec<std::vector<double>> times_trace() {
    Codec<std::vector<double>> codec = trace();
    codec.write = [](const std::vector<double>& values, Writer& out) { out.times(values); };
    codec.schema = [](SchemaBook&) { return Json{{"type", "array"}, {"items", {{"type", "number"}}}}; };
    return codec;
}

Codec<Figure> figure() {
    const Codec<std::optional<double>> plain = nullable_number();
    Codec<Figure> codec;
    codec.write = [write = plain.write](const Figure& figure, Writer& out) { write(figure.value, out); };
    codec.schema = plain.schema;
    codec.undefined = [undefined = plain.undefined](const Figure& figure) { return undefined(figure.value); };
    codec.why = [](const Figure& figure) { return figure.why; };
    return codec;
}

Codec<std::optional<double>> nullable_number() {
    return {{},
            [](const std::optional<double>& value, Writer& out) { value ? out.number(*value) : out.null(); },
            [](SchemaBook&) {
                return Json{{"type", {"number", "null"}}};
            },
            {},
            [](const std::optional<double>& value) { return !value || !std::isfinite(*value); }};
}

Codec<std::optional<bool>> nullable_bool() {
    return {{},
            [](const std::optional<bool>& value, Writer& out) { value ? out.boolean(*value) : out.null(); },
            [](SchemaBook&) {
                return Json{{"type", {"boolean", "null"}}};
            },
            {},
            [](const std::optional<bool>& value) { return !value.has_value(); }};
}

Codec<std::map<std::string, double>> numbers_by_name(std::string keys) {
    return {{},
            [](const std::map<std::string, double>& values, Writer& out) {
                out.begin_object();
                for (const auto& [name, value] : values) out.key(name).number(value);
                out.end_object();
            },
            [keys](SchemaBook&) {
                return Json{{"type", "object"},
                            {"propertyNames", {{"description", keys}}},
                            {"additionalProperties", {{"type", {"number", "null"}}}}};
            }};
}

SchemaOf or_null(SchemaOf inner) {
    return [inner = std::move(inner)](SchemaBook& book) {
        return Json{{"oneOf", {inner(book), Json{{"type", "null"}}}}};
    };
}

std::optional<std::size_t> ChoiceWords::read(const Json& value, Reader& reader) const {
    std::string meant;
    if (value.is_string()) {
        const auto& given = value.get_ref<const std::string&>();
        const auto at = std::find(names.begin(), names.end(), given);
        if (at != names.end()) return static_cast<std::size_t>(at - names.begin());
        meant = nearest(given, names);
    }
    reader.fault(reader.name() + " is " + shown(value) + "; it must be " + listed(names) + "." +
                 (meant.empty() ? "" : " Did you mean " + meant + "?"));
    return std::nullopt;
}

SchemaOf ChoiceWords::schema() const {
    return [names = names](SchemaBook&) { return Json{{"type", "string"}, {"enum", names}}; };
}

bool ArrayLengths::hold(const Json& value, Reader& reader) const {
    if (!value.is_array()) {
        reader.fault(wrong_kind(value, "an array", reader));
        return false;
    }
    if (value.size() < min || value.size() > max) {
        reader.fault(reader.name() + " has " + std::to_string(value.size()) + " elements; it must have " +
                     std::to_string(min) + " to " + std::to_string(max) + ".");
        return false;
    }
    return true;
}

SchemaOf ArrayLengths::schema(SchemaOf items, bool stated) const {
    return [items = std::move(items), stated, *this](SchemaBook& book) {
        Json out{{"type", "array"}, {"items", items(book)}};
        if (stated) {
            out["minItems"] = min;
            out["maxItems"] = max;
        }
        return out;
    };
}

}  // namespace tunewright::api
