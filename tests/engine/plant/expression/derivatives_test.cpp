// Programs with number types other than double: derivatives compared with the complex step, Taylor coefficients with
// dual numbers and known series; and no program computes an expression twice.
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

#include "engine/plant/expression/taylor.h"
#include "tests/engine/plant/expression/compiled_text.h"

namespace tunewright {
namespace {

using Complex = std::complex<double>;

constexpr const char* kTexts[] = {
    "x + u*x - u/x",
    "exp(-x)*u",
    "log(x*u + 1)",
    "sqrt(x^2 + u)",
    "sin(x*u) + cos(x - u)*tan(x/3)",
    "tanh(u*x/4)^3",
    "x^2.5*u^-1.5",
    "x^u",
    "x^7 - u^-3",
    "abs(u - x)*x",
    "min(x*u, x + 10) + max(x, u - 2)",
    "x > u ? x*x : u*x^3",
    "4.71e3*exp(-8/x)*u/(1 + sqrt(x))",
};

TEST(Derivatives, DualNumbersAgreeWithTheComplexStep) {
    constexpr double h = 1e-150;  // nothing is subtracted: as small as possible
    for (const char* text : kTexts)
        for (const double x : {0.3, 1.7, 2.9}) {
            const double u = 1.9;
            const auto dual = value_of<Dual<2>>(text, variable_dual<2>(x, 0), variable_dual<2>(u, 1));
            const auto by_x = value_of<Complex>(text, {x, h}, u), by_u = value_of<Complex>(text, x, {u, h});
            const double scale = 1e-13 * (std::abs(dual.v) + std::abs(dual.d[0]) + std::abs(dual.d[1]));
            EXPECT_NEAR(dual.v, value_of<double>(text, x, u), scale) << text;
            EXPECT_NEAR(dual.d[0], by_x.imag() / h, scale) << text << " at " << x;
            EXPECT_NEAR(dual.d[1], by_u.imag() / h, scale) << text << " at " << x;
        }
}

// Coefficients of the text for x = x0 + x1 t + x2 t^2 and u = u0 + u1 t.
std::vector<double> coefficients(const char* text, std::vector<double> x, std::vector<double> u, int order) {
    const auto program = std::get<Program>(compiled(text));
    TaylorTable<double> table(program, order);
    std::vector<double> result;
    for (int k = 0; k <= order; ++k) {
        const auto at = static_cast<std::size_t>(k);
        table.series(0)[k] = at < x.size() ? x[at] : 0;
        table.series(1)[k] = at < u.size() ? u[at] : 0;
        table.sweep(k, program.length(1));
        result.push_back(table.series(program.output_register(0))[k]);
    }
    return result;
}

// By Cauchy's integral on a small circle in the complex time plane: independent of all recurrences.
double cauchy(const char* text, const std::vector<double>& x, const std::vector<double>& u, int k, double radius) {
    constexpr int kPoints = 64;
    Complex sum = 0;
    for (int i = 0; i < kPoints; ++i) {
        const Complex t = std::polar(radius, 2 * std::acos(-1.0) * i / kPoints);
        Complex xt = 0, ut = 0;
        for (std::size_t j = x.size(); j-- > 0;) xt = xt * t + x[j];
        for (std::size_t j = u.size(); j-- > 0;) ut = ut * t + u[j];
        sum += value_of<Complex>(text, xt, ut) / std::pow(t, k);
    }
    return sum.real() / kPoints;
}

TEST(Derivatives, TaylorCoefficientsAgreeWithCauchysIntegral) {
    const std::vector<double> x = {1.7, 0.4, -0.2}, u = {1.2, -0.3};
    for (const char* text : kTexts) {
        const auto found = coefficients(text, x, u, 6);
        for (int k = 0; k <= 6; ++k)
            EXPECT_NEAR(found[static_cast<std::size_t>(k)], cauchy(text, x, u, k, 0.3),
                        1e-11 * (1 + std::abs(found[0])) * std::pow(3.0, k))
                << text << ", coefficient " << k;
    }
}

TEST(Derivatives, KnownSeries) {
    const auto tangent = coefficients("tan(x)", {0, 1}, {0}, 7);  // t + t^3/3 + 2 t^5/15 + 17 t^7/315
    EXPECT_NEAR(tangent[3], 1.0 / 3, 1e-15);
    EXPECT_NEAR(tangent[5], 2.0 / 15, 1e-15);
    EXPECT_NEAR(tangent[7], 17.0 / 315, 1e-15);
    const auto root = coefficients("sqrt(x)", {1, 1}, {0}, 4);  // 1 + t/2 - t^2/8 + t^3/16 - 5 t^4/128
    EXPECT_DOUBLE_EQ(root[3], 1.0 / 16);
    EXPECT_DOUBLE_EQ(root[4], -5.0 / 128);
}

TEST(Derivatives, OneDualDirectionOnTopOfTaylorDifferentiatesEveryCoefficient) {
    const auto program = std::get<Program>(compiled("exp(u*x)*x"));
    TaylorTable<Dual<1>> table(program, 3);
    const double u = 0.8, h = 1e-6;
    for (int k = 0; k <= 3; ++k) {
        table.series(0)[k] = constant_dual<1>(k == 0 ? 0.5 : k == 1 ? 1 : 0);
        table.series(1)[k] = k == 0 ? variable_dual<1>(u, 0) : constant_dual<1>(0);
        table.sweep(k, program.length(1));
    }
    const auto low = coefficients("exp(u*x)*x", {0.5, 1}, {u - h}, 3);
    const auto high = coefficients("exp(u*x)*x", {0.5, 1}, {u + h}, 3);
    for (int k = 0; k <= 3; ++k)
        EXPECT_NEAR(table.series(program.output_register(0))[k].d,
                    (high[static_cast<std::size_t>(k)] - low[static_cast<std::size_t>(k)]) / (2 * h), 1e-9);
}

std::size_t length(const char* text) { return std::get<Program>(compiled(text)).instructions().size(); }

TEST(Compilation, EqualOperationsAreDoneOnceAndConstantsNow) {
    EXPECT_EQ(length("exp(-a/x)*u + exp(-a/x)*u"), 4U);  // -a is a constant: /, exp, *, +
    EXPECT_EQ(length("(x+u)*(u+x)"), 2U);
    EXPECT_EQ(length("2*3 + exp(1)^2"), 0U);
    EXPECT_EQ(length("x^8"), 3U);
    EXPECT_EQ(length("x + 0*1 - 0"), 0U);
    EXPECT_EQ(length("a > 1 ? x*u : log(-x)"), 1U);
    EXPECT_EQ(length("x^a"), 1U);
}

TEST(Compilation, WhatFailsIsNamedWithItsPlace) {
    const auto fault = [](const char* text, double x, double u) {
        const double variables[] = {x, u};
        return std::get<Program>(compiled(text)).fault<double>(variables, 1);
    };
    EXPECT_EQ(fault("u + 2*log(x)", -3, 1), "text, character 7: log of -3 does not exist");
    EXPECT_EQ(fault("u/(x - 3)", 3, 1), "text, character 2: division by zero");
    EXPECT_EQ(fault("exp(x*u)", 1000, 1), "text, character 1: exp of 1000 is not finite");
    EXPECT_EQ(fault("1 + x^0.5", -2, 0), "text, character 6: -2 ^ 0.5 does not exist");
    EXPECT_EQ(fault("x^-2", 0, 0), "text, character 2: a negative power of 0 is not finite");
    EXPECT_EQ(fault("1e200*x*(1e200*u)", 1, 1), "text, character 8: 1e+200 * 1e+200 is out of the number range");
    EXPECT_EQ(fault("x > 0 ? log(x) : sqrt(x)", -1, 1), "text, character 18: sqrt of -1 does not exist");
    EXPECT_EQ(fault("x > 0 ? log(x) : 7", -1, 1), "");
    const Dual<1> variables[] = {variable_dual<1>(0, 0), constant_dual<1>(1)};
    EXPECT_EQ(std::get<Program>(compiled("u + sqrt(x)")).fault<Dual<1>>(variables, 1),
              "text, character 5: sqrt of 0 has no finite derivative");
}

}  // namespace
}  // namespace tunewright
