#include "engine/tuning/method/options.h"

#include <algorithm>

#include "engine/number_text.h"

namespace tunewright {
namespace {

template <class T>
std::optional<T> find(const std::map<std::string, OptionValue>& values, const std::string& path) {
    const auto at = values.find(path);
    if (at == values.end() || !std::holds_alternative<T>(at->second)) return std::nullopt;
    return std::get<T>(at->second);
}

std::string shown(const OptionValue& value) {
    if (const auto* number = std::get_if<double>(&value)) return text(*number);
    if (const auto* word = std::get_if<std::string>(&value)) return *word;
    return std::get<bool>(value) ? "true" : "false";
}

std::optional<std::string> number_misfit(const OptionDescription& option, double value) {
    if (option.between(value)) return std::nullopt;
    std::string range;
    if (option.minimum) range += " at least " + text(*option.minimum);
    if (option.exclusive_minimum) range += " above " + text(*option.exclusive_minimum);
    if (option.maximum) range += (range.empty() ? " at most " : " and at most ") + text(*option.maximum);
    return option.name + " is " + text(value) + "; it must be" + range + ".";
}

std::string listed(const std::vector<std::string>& words) {
    std::string list;
    for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
    return list;
}

std::optional<std::string> value_misfit(const OptionDescription& option, const OptionValue& value) {
    const auto* number = std::get_if<double>(&value);
    const auto* word = std::get_if<std::string>(&value);
    if (word && std::ranges::find(option.choices, *word) != option.choices.end()) return std::nullopt;
    switch (option.type) {
        case OptionType::number:
        case OptionType::integer:
            if (number) return number_misfit(option, *number);
            return option.name + " is " + shown(value) + "; it must be a number.";
        case OptionType::number_or_word:
            if (number) return number_misfit(option, *number);
            return option.name + " is " + shown(value) + "; it must be a number or " + listed(option.choices) + ".";
        case OptionType::boolean:
            if (std::holds_alternative<bool>(value)) return std::nullopt;
            return option.name + " is " + shown(value) + "; it must be true or false.";
        case OptionType::choice:
            return option.name + " is " + shown(value) + "; it must be one of " + listed(option.choices) + ".";
        case OptionType::text:
            if (word) return std::nullopt;
            return option.name + " is " + shown(value) + "; it must be a text.";
        case OptionType::number_or_range:
        case OptionType::complex:
            if (number) return number_misfit(option, *number);
            return option.name + " is " + shown(value) + "; it must be a number or a pair of numbers.";
        case OptionType::range: return option.name + " must be a pair of numbers.";
        case OptionType::list: return option.name + " must be a list.";
        case OptionType::object:
        case OptionType::numbers_by_name: return option.name + " must be an object.";
    }
    return std::nullopt;
}

// For an option of several values: the fault in the part whose path follows its name.
std::optional<std::string> part_misfit(const OptionDescription& option, const std::string& rest,
                                       const OptionValue& value) {
    const std::size_t slash = rest.find('/');
    switch (option.type) {
        case OptionType::object: return misfit(option.fields, rest, value);
        case OptionType::list:
            if (slash == std::string::npos) return value_misfit(option.fields.front(), value);
            return part_misfit(option.fields.front(), rest.substr(slash + 1), value);
        case OptionType::range:
        case OptionType::number_or_range:
        case OptionType::complex:
        case OptionType::numbers_by_name:
            if (const auto* number = std::get_if<double>(&value)) return number_misfit(option, *number);
            return option.name + " is " + shown(value) + "; it must be a number.";
        default: return option.name + " has no parts.";
    }
}

}  // namespace

std::optional<std::string> misfit(const std::vector<OptionDescription>& options, const std::string& path,
                                  const OptionValue& value) {
    const std::size_t slash = path.find('/');
    const std::string name = path.substr(0, slash);
    const OptionDescription* option = named(options, name);
    if (option == nullptr) {
        std::vector<std::string> names;
        names.reserve(options.size());
        for (const OptionDescription& known : options) names.push_back(known.name);
        return name + " is not one of " + listed(names) + ".";
    }
    if (slash == std::string::npos) return value_misfit(*option, value);
    return part_misfit(*option, path.substr(slash + 1), value);
}

OptionDescription described_option(OptionType type, std::string_view name, std::string_view sentence,
                                   const NumberOption& how, std::optional<OptionValue> preset) {
    OptionDescription option;
    option.name = name;
    option.type = type;
    option.sentence = sentence;
    option.unit = how.unit;
    option.minimum = how.minimum;
    option.exclusive_minimum = how.exclusive_minimum;
    option.maximum = how.maximum;
    option.required = how.required;
    if (preset && !how.required)
        option.default_value = std::move(preset);
    else if (how.fallback)
        option.default_value = *how.fallback;
    return option;
}

const OptionDescription* named(const std::vector<OptionDescription>& options, const std::string& name) {
    const auto at = std::ranges::find(options, name, &OptionDescription::name);
    return at == options.end() ? nullptr : &*at;
}

MethodOptions with_defaults(const std::vector<OptionDescription>& options, const MethodOptions& given) {
    MethodOptions all;
    for (const OptionDescription& option : options)
        if (option.default_value) all.set(option.name, *option.default_value);
    for (const auto& [path, value] : given.values()) all.set(path, value);
    return all;
}

std::optional<double> MethodOptions::number(const std::string& path) const { return find<double>(values_, path); }
std::optional<bool> MethodOptions::boolean(const std::string& path) const { return find<bool>(values_, path); }
std::optional<std::string> MethodOptions::text(const std::string& path) const {
    return find<std::string>(values_, path);
}

std::optional<NumberRange> MethodOptions::range(const std::string& path) const {
    const auto low = number(path + "/0"), high = number(path + "/1");
    if (!low || !high) return std::nullopt;
    return NumberRange{*low, *high};
}

std::size_t MethodOptions::size(const std::string& path) const {
    std::size_t elements = 0;
    for (const std::string& index : names(path)) elements = std::max(elements, std::size_t{std::stoul(index)} + 1);
    return elements;
}

std::vector<std::string> MethodOptions::names(const std::string& path) const {
    const std::string prefix = path + "/";
    std::vector<std::string> below;
    for (auto at = values_.lower_bound(prefix); at != values_.end() && at->first.starts_with(prefix); ++at) {
        const std::string name = at->first.substr(prefix.size(), at->first.find('/', prefix.size()) - prefix.size());
        if (below.empty() || below.back() != name) below.push_back(name);
    }
    return below;
}

}  // namespace tunewright
