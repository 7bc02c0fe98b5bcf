#include "engine/controller/product/typed.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/number_text.h"

namespace tunewright::product {
namespace {

constexpr int kSignificantDigits = 4;  // digits of a floating-point number as entered: relative error at most 5e-4
constexpr int kMinDecimals = 2;

bool takes_number(const Parameter& parameter) {
    if (parameter.shape == Shape::option || parameter.shape == Shape::alpha_code) return false;
    return parameter.shape != Shape::constant ||
           (parameter.standard && std::holds_alternative<double>(*parameter.standard));
}

Error fault(const Product& product, std::string_view name, const std::string& rule) {
    return {ErrorKind::invalid_argument, "settings/" + std::string(name),
            std::string(name) + " of " + std::string(product.name) + " " + rule};
}

std::string names_of(const Product& product) {
    std::string names;
    for (const Parameter& parameter : product.parameters)
        names += (names.empty() ? "" : ", ") + std::string(parameter.name);
    if (!product.action.name.empty()) names += ", " + std::string(product.action.name);
    return names;
}

std::optional<Error> wrong_number(const Product& product, const Parameter& parameter, const Value& value) {
    const double* number = std::get_if<double>(&value);
    if (!number || !std::isfinite(*number))
        return fault(product, parameter.name, "is " + text_of(value) + "; it must be a number.");
    if (parameter.off && *number == *parameter.off) return std::nullopt;
    const double slack = parameter.resolution / 2;
    if (*number >= parameter.range.low - slack && *number <= parameter.range.high + slack) return std::nullopt;
    return fault(product, parameter.name, "is " + text(*number, 6) + "; it must be " + range_text(parameter) + ".");
}

std::optional<Error> wrong_choice(const Product& product, std::string_view name, const Value& value,
                                  const std::vector<Value>& known) {
    if (std::find(known.begin(), known.end(), value) != known.end()) return std::nullopt;
    std::string words;
    for (const Value& one : known) words += (words.empty() ? "" : " or ") + text_of(one);
    return fault(product, name, "is " + text_of(value) + "; it must be " + words + ".");
}

std::optional<Error> wrong_value(const Product& product, const Parameter& parameter, const Value& value) {
    if (takes_number(parameter)) return wrong_number(product, parameter, value);
    if (parameter.shape == Shape::alpha_code) {
        if (decoded_alpha(value)) return std::nullopt;
        return fault(product, parameter.name,
                     "is " + text_of(value) + R"(; it must be "000", or "100" to "199" for alpha 0 to 0.99.)");
    }
    if (parameter.shape == Shape::constant) {
        return parameter.standard ? wrong_choice(product, parameter.name, value, {*parameter.standard}) : std::nullopt;
    }
    std::vector<Value> known;
    for (const Option& option : parameter.options) known.push_back(option.value);
    return wrong_choice(product, parameter.name, value, known);
}

std::string fixed_text(double value, int decimals) {
    char text[400];
    const int n = std::snprintf(text, sizeof text, "%.*f", decimals, value);
    return {text, static_cast<std::size_t>(n)};
}

// Digits before the point count too, so that 1234.567 keeps its two decimals and 0.0083333 has six.
std::string floating_text(double value) {
    value += 0.0;  // -0 would be typed as "-0.00"
    if (!std::isfinite(value) || std::abs(value) >= 1e15) return text(value, kSignificantDigits);
    int decimals = kMinDecimals;
    if (value != 0) {
        const int leading = static_cast<int>(std::floor(std::log10(std::abs(value))));
        decimals = std::clamp(kSignificantDigits - 1 - leading, kMinDecimals, 300);
    }
    std::string text = fixed_text(value, decimals);
    const std::size_t min = text.find('.') + 1 + kMinDecimals;
    while (text.size() > min && text.back() == '0') text.pop_back();
    return text;
}

int decimals_of(double resolution) {
    int decimals = 0;
    while (decimals < 9 && std::abs(resolution - std::round(resolution)) > 1e-9 * resolution) {
        resolution *= 10;
        ++decimals;
    }
    return decimals;
}

}  // namespace

std::optional<Error> wrong_setting(const Product& product, const Settings& settings) {
    for (const Setting& setting : settings) {
        if (!product.action.name.empty() && setting.name == product.action.name) {
            if (auto wrong =
                    wrong_choice(product, setting.name, setting.value, {product.action.reverse, product.action.direct}))
                return wrong;
            continue;
        }
        const Parameter* parameter = parameter_named(product, setting.name);
        if (!parameter)
            return fault(product, setting.name, "is unknown. Its parameters are " + names_of(product) + ".");
        if (auto wrong = wrong_value(product, *parameter, setting.value)) return wrong;
    }
    return std::nullopt;
}

const Value* setting_named(const Settings& settings, std::string_view name) {
    for (const Setting& setting : settings)
        if (setting.name == name) return &setting.value;
    return nullptr;
}

std::optional<double> number_of(const Parameter& parameter, const Settings& settings) {
    if (const Value* given = setting_named(settings, parameter.name)) {
        if (const double* number = std::get_if<double>(given)) return *number;
    }
    if (!parameter.standard) return std::nullopt;
    const double* number = std::get_if<double>(&*parameter.standard);
    return number ? std::optional(*number) : std::nullopt;
}

namespace {

/// True if a parameter has an effect with one option of a choice.
bool counts_with(const Parameter& parameter, const Parameter& choice, const Option& option) {
    switch (parameter.role) {
        case ParameterRole::weight_b:
        case ParameterRole::weight_c:
            return option.free_weights || std::ranges::none_of(choice.options, &Option::free_weights);
        case ParameterRole::integral: return option.integral.value_or(true);
        case ParameterRole::derivative: return option.derivative.value_or(true);
        default: return true;
    }
}

/// True if it is given, and its value does not mean "none".
bool asks_for_effect(const Parameter& parameter, const Settings& settings) {
    const Value* given = setting_named(settings, parameter.name);
    if (!given) return false;
    if (parameter.role == ParameterRole::integral) return !parameter.off || *given != Value(*parameter.off);
    return parameter.role != ParameterRole::derivative || *given != Value(0.0);
}

}  // namespace

const Option& option_of(const Product& product, const Parameter& parameter, const Settings& settings) {
    if (const Value* given = setting_named(settings, parameter.name)) {
        for (const Option& option : parameter.options)
            if (option.value == *given) return option;
    }
    for (const Option& option : parameter.options) {
        if (std::ranges::all_of(product.parameters, [&](const Parameter& one) {
                return !asks_for_effect(one, settings) || counts_with(one, parameter, option);
            }))
            return option;
    }
    return parameter.options.front();
}

bool counts(const Product& product, const Parameter& parameter, const Settings& settings) {
    return std::ranges::all_of(product.parameters, [&](const Parameter& choice) {
        return choice.options.empty() || counts_with(parameter, choice, option_of(product, choice, settings));
    });
}

std::optional<double> decoded_alpha(const Value& code) {
    constexpr double kDefaultAlpha = 0.65;
    std::string digits = text_of(code);
    if (std::holds_alternative<double>(code) && digits == "0") digits = "000";
    if (digits.size() != 3 || digits.find_first_not_of("0123456789") != std::string::npos) return std::nullopt;
    if (digits == "000") return kDefaultAlpha;
    if (digits[0] != '1') return std::nullopt;
    return std::stoi(digits.substr(1)) / 100.0;
}

std::string encoded_alpha(double alpha) {
    const int hundredths = static_cast<int>(std::lround(100 * std::clamp(alpha, 0.0, 0.99)));
    return std::to_string(100 + hundredths);
}

double rounded(const Parameter& parameter, double value) {
    if (parameter.off && value == *parameter.off) return value;
    // Divides by the steps per unit if they are whole: 0.001 times a number is not the decimal that is entered.
    const double steps = 1 / parameter.resolution, whole = std::round(steps);
    if (parameter.resolution > 0 && std::abs(steps - whole) <= 1e-9 * whole)
        value = std::round(value * whole) / whole;
    else if (parameter.resolution > 0)
        value = std::round(value / parameter.resolution) * parameter.resolution;
    return std::clamp(value, parameter.range.low, parameter.range.high);
}

std::string range_text(const Parameter& parameter) {
    const Range& range = parameter.range;
    const std::string unit = parameter.unit.empty() ? "" : " " + std::string(parameter.unit);
    constexpr int kAllDigits = 10;  // of a 32-bit integer
    const std::string low = text(range.low, kAllDigits), high = text(range.high, kAllDigits);
    if (std::isinf(range.high)) return "at least " + low + unit;
    if (std::isinf(range.low)) return "at most " + high + unit;
    return low + " to " + high + unit;
}

Settings as_typed(const Product& product, const Settings& settings) {
    Settings typed = settings;
    for (Setting& setting : typed) {
        const Parameter* parameter = parameter_named(product, setting.name);
        double* number = std::get_if<double>(&setting.value);
        if (parameter && number && parameter->shape != Shape::option) *number = rounded(*parameter, *number);
    }
    return typed;
}

std::string typed_text(const Product& product, const Setting& setting) {
    const Parameter* parameter = parameter_named(product, setting.name);
    const double* number = std::get_if<double>(&setting.value);
    if (!parameter || !number || parameter->shape == Shape::option) return text_of(setting.value);
    const double value = rounded(*parameter, *number);
    return parameter->resolution > 0 ? fixed_text(value, decimals_of(parameter->resolution)) : floating_text(value);
}

}  // namespace tunewright::product
