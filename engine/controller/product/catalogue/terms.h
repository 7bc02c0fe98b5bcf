// Parts that the tables of the catalogue share: terms of many parameters, and the design of most examples.
#pragma once

#include <utility>

#include "engine/controller/product/catalogue.h"

namespace tunewright::product {

inline constexpr Term times(double factor, Term term) {
    term.factor *= factor;
    return term;
}
/// A gain in percent of the output's span per percent of the measurement's span.
inline constexpr Term of_spans(Term term) {
    term.Sy += 1;
    term.Su -= 1;
    return term;
}
/// A gain in fractions of the output's span.
inline constexpr Term of_output(Term term) {
    term.Su -= 1;
    return term;
}

inline constexpr Term kKp{.Kp = 1};
inline constexpr Term kTi{.Ti = 1};
inline constexpr Term kTd{.Td = 1};
inline constexpr Term kTf{.Tf = 1};
inline constexpr Term kKi{.Kp = 1, .Ti = -1};
inline constexpr Term kKd{.Kp = 1, .Td = 1};
inline constexpr Term kKn = of_spans(kKp);
/// Proportional band, 100/Kn, in percent of the measurement's span.
inline constexpr Term kBand{.factor = 100, .Kp = -1, .Sy = -1, .Su = 1};
inline constexpr Term kFilterRatio{.Td = -1, .Tf = 1};
inline constexpr Term kFilterGain{.Td = 1, .Tf = -1};  ///< N
inline constexpr double kMinutes = 1.0 / 60;           ///< minutes in one second
inline constexpr double kPerMinute = 60;
inline constexpr double kWholeNumber = 1;  ///< resolution

inline constexpr Range kShare{0, 1};
inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();
inline constexpr double kMaxSignedWord = 32767;  ///< 16 bits with a sign

/// 1.5 %/degC, 120 s, 20 s, Tf 2 s on 0..200 degC and 0..100 %.
inline constexpr IdealPid kDesignA{
    .Kp = 1.5, .Ti = 120, .Td = 20, .b = 0.6, .c = 0, .filter = {FilterType::derivative, 2}};
inline Example of_design_a(Settings settings) { return {.design = kDesignA, .settings = std::move(settings)}; }
/// For flight controllers: per rad/s and normalised output.
inline constexpr IdealPid kRateDesign{
    .Kp = 0.135, .Ti = 1, .Td = 0.0267, .b = 1, .c = 0, .filter = {FilterType::derivative, 0.00795775}};

/// A choice that is fixed for this entry: another value belongs to another entry, or to none.
inline Parameter fixed_choice(std::string_view name, std::string_view label, Value value,
                              std::string_view remark = "") {
    return {.name = name,
            .label = label,
            .role = ParameterRole::fixed,
            .shape = Shape::constant,
            .standard = std::move(value),
            .remark = remark};
}

inline const Action kSigned{.kind = Action::Kind::signed_gain, .text = "A negative gain gives direct action."};

}  // namespace tunewright::product
