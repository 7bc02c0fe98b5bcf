// The second design of every product, and the blocks' own transfer functions, written from the published conversions
// and not from the terms of the catalogue.
#pragma once

#include <complex>
#include <functional>
#include <map>

#include "tests/engine/controller/product/support.h"

namespace tunewright::product::second {

using Complex = std::complex<double>;

inline constexpr double Kp = 0.8, Ti = 37, Td = 6, Tf = 0.9, b = 0.35, Sy = 400, Su = 16, Ts = 0.25, Kn = Kp * Sy / Su;
inline constexpr double kPi = 3.14159265358979323846;
inline const IdealPid kDesign{.Kp = Kp, .Ti = Ti, .Td = Td, .b = b, .c = 0, .filter = {FilterType::derivative, Tf}};

/// Transfer functions from r and from -y to u.
struct Law {
    Complex r, y;
};

inline Law ideal(double K, double ti, double td, double tf, double wb, double wc, Complex s) {
    const Complex I = 1.0 / (ti * s), D = td * s / (1.0 + tf * s);
    return {K * (wb + I + wc * D), K * (1.0 + I + D)};
}
inline Law parallel(double P, double I, double D, double tf, double wb, double wc, Complex s) {
    const Complex d = D * s / (1.0 + tf * s);
    return {P * wb + I / s + wc * d, P + I / s + d};
}
inline Law series(double K, double ti, double td, double alpha, Complex s) {
    const Complex PI = K * (1.0 + 1.0 / (ti * s));
    return {PI, PI * (1.0 + td * s) / (1.0 + alpha * td * s)};
}

/// Numbers of the settings, and words unchanged.
struct Typed {
    const Settings& settings;
    double operator[](const char* name) const { return number(settings, name); }
    bool is(const char* name, const char* value) const { return named(settings, name) == value; }
};

struct Row {
    std::map<std::string, double> numbers;     ///< the settings to type
    std::map<std::string, std::string> words;  ///< choices
    std::function<Law(const Typed&, Complex)> block;
};

// The filter's ratio is given; for alpha = 0 the interacting form without a filter.
struct SeriesTimes {
    explicit SeriesTimes(double alpha)
        : td((Ti - std::sqrt(Ti * Ti - 4 * Ti * Td / (1 - alpha))) / 2), ti(Ti - (1 - alpha) * td) {}
    double td, ti;
    double gain() const { return ti / Ti; }
};

inline const SeriesTimes kDeltaV(0.125), kHoneywell(0.1), kFoxboro(0);

/// By id: industrial blocks, heaters and small boards, software.
const std::map<std::string, Row>& industrial_rows();
const std::map<std::string, Row>& heater_rows();
const std::map<std::string, Row>& software_rows();

}  // namespace tunewright::product::second
