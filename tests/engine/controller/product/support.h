// Common helpers of the tests of products.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <string>

#include "engine/controller/product/catalogue.h"
#include "engine/controller/product/settings.h"

namespace tunewright::product {

constexpr double kNever = std::numeric_limits<double>::infinity();
/// The design that most of them convert, and its context.
const IdealPid kDesign{.Kp = 1.5, .Ti = 120, .Td = 20, .b = 0.6, .c = 0, .filter = {FilterType::derivative, 2}};
const Context kContext = Context::with_spans({.y_low = 0, .y_high = 200, .u_low = 0, .u_high = 100}, 0.25);

inline Context context_of(const Example& example) {
    return Context::with_spans({.y_low = 0, .y_high = example.y_span, .u_low = 0, .u_high = example.u_span},
                               example.sample_time_s);
}

/// Spans 50..450 and 4..20.
inline Context context_b(double Ts = 0.25) {
    return Context::with_spans({.y_low = 50, .y_high = 450, .u_low = 4, .u_high = 20}, Ts);
}

inline const Product& product_of(std::string_view id) {
    const Product* product = find(id);
    if (!product) throw std::runtime_error("no product " + std::string(id));
    return *product;
}

inline double number(const Settings& settings, std::string_view name) {
    for (const Setting& setting : settings)
        if (setting.name == name && std::holds_alternative<double>(setting.value))
            return std::get<double>(setting.value);
    ADD_FAILURE() << "no number " << name;
    return NAN;
}

inline std::string named(const Settings& settings, std::string_view name) {
    for (const Setting& setting : settings)
        if (setting.name == name) return text_of(setting.value);
    return "";
}

inline bool has_note(const std::vector<Note>& notes, std::string_view code) {
    return std::any_of(notes.begin(), notes.end(), [&](const Note& note) { return note.code == code; });
}

inline std::string note(const std::vector<Note>& notes, std::string_view code) {
    for (const Note& one : notes)
        if (one.code == code) return one.detail;
    return "";
}

/// Equal to this number of significant digits.
inline ::testing::AssertionResult to_digits(double a, double b, double relative) {
    if (a == b || std::abs(a - b) <= relative * std::max(std::abs(a), std::abs(b)))
        return ::testing::AssertionSuccess();
    char text[100];
    std::snprintf(text, sizeof text, "%.12g and %.12g", a, b);
    return ::testing::AssertionFailure() << text;
}

}  // namespace tunewright::product
