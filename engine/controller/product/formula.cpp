#include "engine/controller/product/formula.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/number_text.h"

namespace tunewright::product {
namespace {

struct Symbol {
    double Term::*exponent;
    double Quantities::*quantity;
    const char* name;
    const char* series_name;
};

constexpr Symbol kSymbols[] = {
    {&Term::Kp, &Quantities::Kp, "Kp", "Kc"},
    {&Term::Td, &Quantities::Td, "Td", "td"},
    {&Term::ideal_Td, &Quantities::ideal_Td, "Td", "Td"},
    {&Term::Ti, &Quantities::Ti, "Ti", "ti"},
    {&Term::Tf, &Quantities::Tf, "Tf", "Tf"},
    {&Term::Sy, &Quantities::Sy, "Sy", "Sy"},
    {&Term::Su, &Quantities::Su, "Su", "Su"},
    {&Term::Ts, &Quantities::Ts, "Ts", "Ts"},
    {&Term::K, &Quantities::K, "K", "K"},
};

double power(double x, double exponent) { return exponent == 1 ? x : std::pow(x, exponent); }

// Multiplies numerators and denominators separately, so that no factor is rounded by a reciprocal.
double product_of(const Term& term, const Quantities& quantities, double Quantities::*without) {
    double above = term.factor, below = 1;
    for (const Symbol& symbol : kSymbols) {
        const double exponent = term.*symbol.exponent;
        if (exponent == 0 || symbol.quantity == without) continue;
        const double x = quantities.*symbol.quantity;
        exponent > 0 ? above *= power(x, exponent) : below *= power(x, -exponent);
    }
    return above / below;
}

struct Fraction {
    std::string above, below;
    int factors_below = 0;

    void multiply(const std::string& factor) { above += (above.empty() ? "" : " ") + factor; }
    void divide(const std::string& factor) {
        below += (below.empty() ? "" : " ") + factor;
        ++factors_below;
    }
    std::string text() const {
        if (below.empty()) return above.empty() ? "1" : above;
        return (above.empty() ? "1" : above) + "/" + (factors_below > 1 ? "(" + below + ")" : below);
    }
};

// Writes a factor such as 1/60 as a divisor if that is shorter.
void add_factor(double factor, Fraction& fraction) {
    if (factor == 1) return;
    if (factor == -1) return fraction.multiply("-1");
    if (std::abs(1 / factor - 2 * std::numbers::pi) < 1e-12) {
        fraction.divide("2 pi");
        ++fraction.factors_below;
        return;
    }
    const std::string as_factor = tunewright::text(factor, 10), as_divisor = tunewright::text(1 / factor, 10);
    as_factor.size() <= as_divisor.size() ? fraction.multiply(as_factor) : fraction.divide(as_divisor);
}

std::string term_text(const Term& term, bool series) {
    Fraction fraction;
    add_factor(term.factor, fraction);
    std::string root;
    for (const Symbol& symbol : kSymbols) {
        const double exponent = term.*symbol.exponent;
        const std::string name = series ? symbol.series_name : symbol.name;
        if (exponent == 0.5) {
            root += (root.empty() ? "" : " ") + name;
        } else if (exponent != 0) {
            exponent > 0 ? fraction.multiply(name) : fraction.divide(name);
        }
    }
    if (!root.empty()) fraction.multiply("sqrt(" + root + ")");
    return fraction.text();
}

std::string options_text(const Parameter& parameter) {
    std::string text;
    for (const Option& option : parameter.options) {
        text += (text.empty() ? "" : "; ") + text_of(option.value) + ":";
        if (option.b) text += " b = " + tunewright::text(*option.b);
        if (option.c) text += std::string(option.b ? "," : "") + " c = " + tunewright::text(*option.c);
        if (option.free_weights) text += " b and c are set";
        if (option.integral) text += *option.integral ? " integral action" : " no integral action";
        if (option.derivative) text += *option.derivative ? " derivative action" : " no derivative action";
        if (option.filter == FilterType::derivative) text += " filter of the derivative";
        if (option.filter == FilterType::measurement_second_order) text += " second-order filter of the measurement";
    }
    return text;
}

}  // namespace

double value_of(const Term& term, const Quantities& quantities) { return product_of(term, quantities, nullptr); }

double solved(const Term& term, const Quantities& quantities, double Quantities::*unknown, double exponent,
              double value) {
    const double rest = product_of(term, quantities, unknown);
    if (exponent == 1) return value / rest;
    if (exponent == -1) return rest / value;
    return std::pow(value / rest, 1 / exponent);
}

double filter_value(const Parameter& parameter, const Quantities& quantities, double clock) {
    const double Tf = quantities.Tf;
    switch (parameter.shape) {
        case Shape::plus_clock: return Tf + clock;
        case Shape::lag_per_sample: return Tf / (Tf + clock);
        case Shape::slope_samples: return 1 + 2 * Tf / clock;
        default: return value_of(parameter.term, quantities);
    }
}

double filter_time(const Parameter& parameter, const Quantities& quantities, double clock, double value) {
    switch (parameter.shape) {
        case Shape::plus_clock: return std::max(value - clock, 0.0);
        case Shape::lag_per_sample: return value * clock / (1 - value);
        case Shape::slope_samples: return slope_filter_time(value, clock);
        default: return solved(parameter.term, quantities, &Quantities::Tf, parameter.term.Tf, value);
    }
}

double slope_filter_time(double samples, double Ts) { return (samples - 1) * Ts / 2; }

int whole_samples(double samples) {
    constexpr double kMaxSamples = 1e6;
    return static_cast<int>(std::lround(std::clamp(samples, 1.0, kMaxSamples)));
}

std::string formula_text(const Product& product, const Parameter& parameter) {
    switch (parameter.shape) {
        case Shape::power: return term_text(parameter.term, product.form == Form::series);
        case Shape::one_minus_b: return "1 - b";
        case Shape::weight: return parameter.role == ParameterRole::weight_b ? "b" : "c";
        case Shape::feedforward: return "(b - 1) Kp";
        case Shape::alpha_code: return "100 + 100 (1 - b)";
        case Shape::plus_clock: return "Tf + dt";
        case Shape::lag_per_sample: return "Tf/(Tf + dt)";
        case Shape::slope_samples: return "1 + 2 Tf/Ts";
        case Shape::option: return options_text(parameter);
        case Shape::constant: return parameter.standard ? text_of(*parameter.standard) : "";
    }
    return "";
}

}  // namespace tunewright::product
