#include <algorithm>
#include <cstdlib>
#include <sstream>
#include <stdexcept>

#include "engine/code/print.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/code/algorithm.h"

namespace tunewright::code {
namespace {

using testing::HasSubstr;
using testing::Not;

constexpr Language kLanguages[] = {Language::structured_text, Language::c, Language::python};

// One assignment to u, as a statement of the three languages.
std::vector<std::string> written(const std::function<Expr(Program&)>& make) {
    std::vector<std::string> out;
    for (const Language language : kLanguages) {
        Program program;
        const Expr u = program.declare({.role = VariableRole::output, .name = "u"});
        program.body.push_back(assign(u, make(program)));
        const std::string text = print(program, language, {});
        // The head comment above the statement also assigns u.
        const std::size_t begin = std::min(text.rfind("u := "), text.rfind("u = "));
        out.push_back(text.substr(begin, text.find('\n', begin) - begin));
    }
    return out;
}

Expr local(Program& program, const char* name, Type type = Type::real) {
    return program.declare({.role = VariableRole::local, .type = type, .name = name});
}

TEST(CodePrinter, AnExpressionKeepsTheOrderInWhichItWasBuilt) {
    EXPECT_EQ(written([](Program& p) {
                  const Expr a = local(p, "a"), b = local(p, "b"), d = local(p, "d");
                  return a - (b - d) * (a + b) / (b * d) + (a + b);
              }),
              (std::vector<std::string>{"u := a - (b - d) * (a + b) / (b * d) + (a + b);",
                                        "u = a - (b - d) * (a + b) / (b * d) + (a + b);",
                                        "u = a - (b - d) * (a + b) / (b * d) + (a + b)"}));
    EXPECT_EQ(written([](Program& p) { return -local(p, "a") * -(local(p, "b") + 1) - exponential(-2.5); })[1],
              "u = (-a) * (-(b + 1.0)) - exp(-2.5);");
}

TEST(CodePrinter, NumbersReadBackAndAreRealNumbers) {
    EXPECT_EQ(real_literal(10, 'e'), "10.0");
    EXPECT_EQ(real_literal(0.1, 'e'), "0.1");
    EXPECT_EQ(real_literal(-1e-5, 'E'), "-1.0E-5");
    EXPECT_EQ(real_literal(1e30, 'E'), "1.0E30");
    EXPECT_EQ(real_literal(1.0 / 3, 'e'), "0.3333333333333333");
    EXPECT_EQ(real_literal(2.5e-10, 'e'), "2.5e-10");
    for (const double x : {1.0 / 3, 2.0 / 3e-7, 123456.789e12, 5e-324})
        EXPECT_EQ(std::strtod(real_literal(x, 'e').c_str(), nullptr), x);
}

TEST(CodePrinter, NothingThatAUserWroteEndsTheComment) {
    const auto program = pid_algorithm({.gains = {.Kp = 1, .Ki = 1}, .Ts = 1}, {});
    const std::string evil = "a */ b /* c *) d (* e ?\?/ f \\ g \n h \xC2\xB0 i \xE2\x82\xAC \x7F // **//";
    for (const Language language : kLanguages) {
        const std::string text = print(*program, language, {{"Loop", evil}});
        EXPECT_THAT(text, HasSubstr("a * / b / * c * ) d ( * e ? ?/ f / g   h deg "));
        std::size_t lines_before_code = text.find(language == Language::python ? "class"
                                                  : language == Language::c    ? "#ifndef"
                                                                               : "FUNCTION");
        const std::string head = text.substr(0, lines_before_code);
        for (const char c : head) EXPECT_TRUE(c == '\n' || (c >= ' ' && c < 0x7F));
        if (language == Language::python) {
            std::istringstream lines(head);
            for (std::string line; std::getline(lines, line);) EXPECT_TRUE(line.empty() || line[0] == '#') << line;
        } else {
            const std::string end = language == Language::c ? "*/" : "*)";
            EXPECT_EQ(head.find(end), head.rfind(end));
        }
    }
}

TEST(CodePrinter, TheHeadTellsSettingsRulesAndHowItIsCalled) {
    SampledPid pid{.gains = {.Kp = -2, .Ki = -0.5, .Kd = -4}, .Ts = 0.25};
    pid.derivative = DerivativeRule::four_points;
    const auto program = pid_algorithm(pid, {.anti_windup = AntiWindup::clamping, .u_min = 0, .u_max = 100});
    const std::string text = print(*program, Language::c, {{"Ms", "1.4"}});
    for (const char* part : {" * Ms            1.4\n", "Kp 2, Ti 4, Td 2, b 1, u_min 0, u_max 100", "(backward rule)",
                             "Anti-windup by clamping", "tunewright_pid_init(&pid);", "pid->direct = true;"})
        EXPECT_THAT(text, HasSubstr(part));
    EXPECT_THAT(text, Not(HasSubstr("Not both limits")));
    const auto open = pid_algorithm(pid, {.u_min = 0});
    EXPECT_THAT(print(*open, Language::python, {}), HasSubstr("Not both limits were given"));
}

TEST(CodeProgram, FaultsOfTheProgramThatBuildsAreNotPrinted) {
    Program program;
    const Expr x = program.declare({.role = VariableRole::state, .name = "x"}),
               yes = program.declare({.role = VariableRole::input, .type = Type::boolean, .name = "yes"}),
               n = program.declare({.role = VariableRole::local, .type = Type::integer, .name = "n"});
    EXPECT_THROW(program.declare({.name = "X"}), std::logic_error);  // Structured Text is not case-sensitive
    EXPECT_THROW(x + yes, std::logic_error);
    EXPECT_THROW(x + n, std::logic_error);
    EXPECT_THROW(n / n, std::logic_error);
    EXPECT_THROW(both(x, yes), std::logic_error);
    EXPECT_THROW(when(x, {assign(x, 1.0)}), std::logic_error);
    EXPECT_THROW(assign(yes, truth(true)), std::logic_error);
    EXPECT_THROW(assign(x, n), std::logic_error);
}

}  // namespace
}  // namespace tunewright::code
