// The meaning of a text, and the errors of one that is not valid.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/plant/expression/compiled_text.h"

namespace tunewright {
namespace {

double value(const std::string& text, double x = 3, double u = 5) { return value_of<double>(text, x, u); }

TEST(Grammar, OperatorsBindAsInMathematics) {
    const std::pair<const char*, double> cases[] = {
        {"1+2*3", 7},
        {"(1+2)*3", 9},
        {"8-4-2", 2},
        {"16/4/2", 2},
        {"2^3^2", 512},
        {"-x^2", -9},
        {"(-x)^2", 9},
        {"2^-1", 0.5},
        {"2^-x^2", std::pow(2.0, -9.0)},
        {"-2^-2", -0.25},
        {"x--u", 8},
        {"x*-u", -15},
        {"+x - +u", -2},
        {"2*x^2*u", 90},
        {"1e3 + 1.5E-1 + .5 + 2.", 1002.65},
        {"4.71e8/a", 2.355e8},
        {"x < u", 1},
        {"x >= u", 0},
        {"x + 1 == 4", 1},
        {"x != 3", 0},
        {"x > u ? 1 : x < u ? 2 : 3", 2},
        {"x <= 3 ? u : log(-1)", 5},
        {"x > 0 ? x > 1 ? 10 : 20 : 30", 10},
        {"1 ? 2 : 3 + 4", 2},
        {"min(x, u, 1) + max(x, u, 1)", 6},
        {"abs(x - u)", 2},
        {"sqrt(x*x)", 3},
        {"exp(log(x))", 3},
        {"tanh(x) - (exp(x)-exp(-x))/(exp(x)+exp(-x))", 0},
        {"sin(x)^2 + cos(x)^2 + tan(0)", 1},
        {"x^2.5", std::pow(3.0, 2.5)},
        {"x^u", 243},
        {"x^-3", 1.0 / 27},
        {"x^0", 1},
        {" x\t+\n u ", 8},
    };
    for (const auto& [text, expected] : cases)
        EXPECT_NEAR(value(text), expected, 1e-13 * (1 + std::abs(expected))) << text;
}

TEST(Grammar, ErrorsNameThePlaceAndQuoteThePiece) {
    const std::pair<const char*, const char*> cases[] = {
        {"", "the expression is empty."},
        {"   ", "the expression is empty."},
        {"1 +", "character 4: the expression ends where a number, a name or a parenthesis belongs."},
        {"x + * u", "character 5: \"*\" stands where a number, a name or a parenthesis belongs."},
        {"(x + u", "character 1: this parenthesis is not closed."},
        {"x + u)", "character 6: \")\" stands where an operator or the end belongs."},
        {"2x", "character 1: \"2x\" is not a number; write an operator such as * between a number and a name."},
        {"1e + x", "character 1: \"1e\" is not a number; write an operator such as * between a number and a name."},
        {"1.2.3", "character 1: \"1.2.3\" is not a number; write an operator such as * between a number and a name."},
        {"x u", "character 3: \"u\" stands where an operator or the end belongs."},
        {"x(u)",
         "character 1: \"x\" is not a function; the functions are exp, log, sqrt, sin, cos, tan, tanh, abs, min and "
         "max. "
         "A product needs a *."},
        {"exp", "character 1: \"exp\" is a function: write exp(...)."},
        {"exp(x, u)", "character 1: \"exp\" takes one argument, not 2."},
        {"min(x)", "character 1: \"min\" takes two or more arguments, not 1."},
        {"exp(x", "character 1: the parenthesis of \"exp\" is not closed."},
        {"exp()", "character 5: \")\" stands where a number, a name or a parenthesis belongs."},
        {"x ? u", "character 6: the expression ends where the \":\" of the conditional belongs."},
        {"0 < x < 1", "character 7: comparisons cannot be chained; write a < b ? b < c : 0 for a < b < c."},
        {"x = u", "character 3: \"=\" is not an operator; write equality as ==."},
        {"x ** 2", "character 3: \"**\" is not an operator; write a power with ^."},
        {"x + y", "character 5: y is unknown"},
        {"x $ u", "character 3: \"$\" cannot be part of an expression."},
        {"x \xC2\xB7 u", "character 3: \"\xC2\xB7\" cannot be part of an expression."},
        {"x \xFF u", "character 3: \"\\xFF\" cannot be part of an expression."},
        {"1e999", "character 1: \"1e999\" is out of the range of double precision."},
        {"x;system(u)", "character 2: \";\" cannot be part of an expression."},
    };
    for (const auto& [text, expected] : cases) EXPECT_EQ(complaint(text), expected) << text;
}

TEST(Grammar, CharactersCountAsPeopleCountThem) {
    EXPECT_THAT(complaint("x + \xC3\xA9"), testing::HasSubstr("character 5"));
}

TEST(Grammar, LimitsHoldWithoutExhaustingTheStack) {
    EXPECT_EQ(complaint(std::string(100000, '(')), "the expression is 100000 characters long; at most 10000 are read.");
    for (const char* opener : {"(", "-", "exp(", "2^", "x?1:", "x?", "+", "min(1,"}) {
        std::string text;
        for (int i = 0; i < 1000; ++i) text += opener;
        EXPECT_THAT(complaint(text), testing::HasSubstr("is nested more than 100 levels deep")) << opener;
    }
    std::string just(99, '('), sum = "x";
    EXPECT_EQ(complaint(just + "x" + std::string(99, ')')), "");
    for (int i = 0; i < 2600; ++i) sum += "+x";
    EXPECT_THAT(complaint(sum), testing::HasSubstr("more than 5000 numbers, names and operations"));
    std::string tower = "2";
    for (int i = 0; i < 6; ++i) tower = "2^(" + tower + ")";
    EXPECT_EQ(complaint(tower), "");  // overflows in the first evaluation
    EXPECT_TRUE(std::isinf(value(tower)));
}

}  // namespace
}  // namespace tunewright
