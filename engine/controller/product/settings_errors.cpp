#include "engine/controller/product/settings_errors.h"

#include <cmath>

namespace tunewright::product {
namespace {

/// The quantity of that name; null if the law has none.
double* quantity_of(IdealPid& pid, const std::string& name) {
    if (name == "Kp") return &pid.Kp;
    if (name == "Ti") return &pid.Ti;
    if (name == "Td") return &pid.Td;
    if (name == "Tf") return &pid.filter.Tf;
    return name == "b" ? &pid.b : nullptr;
}

std::map<std::string, double> numbers_of(const Product& product, const IdealPid& pid, const Context& context) {
    std::map<std::string, double> numbers;
    const auto converted = to_settings(product, pid, context, true);
    if (!converted) return numbers;
    for (const Setting& setting : converted->settings)
        if (const auto* number = std::get_if<double>(&setting.value)) numbers[setting.name] = *number;
    return numbers;
}

}  // namespace

std::map<std::string, double> settings_errors(const Product& product, const IdealPid& pid,
                                              const std::map<std::string, double>& errors, const Context& context) {
    constexpr double kShare = 0.01;  // of a deviation: a large one may leave the range in which the law has this form
    std::map<std::string, double> squares;
    const auto typed = numbers_of(product, pid, context);
    for (const auto& [name, error] : errors) {
        IdealPid above = pid, below = pid;
        double *up = quantity_of(above, name), *down = quantity_of(below, name);
        if (up == nullptr || !std::isfinite(error)) continue;
        *up += kShare * error;
        *down -= kShare * error;
        const auto high = numbers_of(product, above, context), low = numbers_of(product, below, context);
        for (const auto& [setting, value] : high) {
            const auto other = low.find(setting);
            if (other != low.end() && typed.contains(setting))
                squares[setting] += std::pow((value - other->second) / (2 * kShare), 2);
        }
    }
    std::erase_if(squares, [](const auto& setting) { return !(setting.second > 0); });
    for (auto& [setting, square] : squares) square = std::sqrt(square);
    return squares;
}

}  // namespace tunewright::product
